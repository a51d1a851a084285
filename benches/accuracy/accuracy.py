#!/usr/bin/env python3
"""How far the accelerated solver is from explicit steps in double precision.

    python3 benches/accuracy/accuracy.py [NAME...]

Needs cargo, gcc and Python with NumPy (benches/accuracy/requirements.txt). Records each bundled
scenario with its fields, takes the same cloth through the process of docs/fields.md in explicit steps
of paper D's length in double precision (explicit.c, a few minutes in all), and prints the largest
and the root mean square difference of concentrations of free dye and of bound dye. Ends with 1 where
one passes its bound.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MOST, MOST_RMS = 1 / 255, 1 / 2000
FIGURES = [f"fig8{x}" for x in "abcdefg"] + [f"fig9{x}" for x in "abc"] + [f"fig10{x}" for x in "abc"]
# Steps in all and between frames, and the moments that are compared.
LONG = (50_000, 1250, [1250, 5000, 12_500, 50_000])
SHORT = (5000, 250, [250, 1250, 2500, 5000])


def build():
    command = ["cargo", "build", "--release", "--message-format", "json"]
    lines = subprocess.run(command, check=True, cwd=ROOT, stdout=subprocess.PIPE).stdout.splitlines()
    messages = [json.loads(line) for line in lines]
    return next(m["executable"] for m in reversed(messages) if m.get("executable"))


def problem(cloth, state, steps):
    """The bytes that explicit.c reads."""
    scale = float(cloth["dt_h"]) / float(cloth["cell_mm"]) ** 2
    v_u = cloth["capacity_free"].astype(float)
    _, ny, nx = v_u.shape
    east, south = np.zeros_like(v_u), np.zeros_like(v_u)
    east[:, :, :-1] = scale * cloth["face_x"] * np.minimum(v_u[:, :, :-1], v_u[:, :, 1:])
    south[:, :-1] = scale * cloth["face_y"] * np.minimum(v_u[:, :-1], v_u[:, 1:])
    beside = scale * cloth["face_z"] * np.minimum(v_u[0], v_u[1])
    numbers = [cloth["phi0"], cloth["isotherm_k"], cloth["isotherm_b"], cloth["dab_mm2_h"] * scale]
    fields = [numbers, steps, east, south, beside, v_u, cloth["capacity_bound"]]
    fields += [state["free"], state["bound"], state["held"]]
    head = np.array([ny, nx, len(steps), int(cloth["isotherm"])], dtype=np.int64)
    return head.tobytes() + b"".join(np.asarray(f, dtype=float).tobytes() for f in fields)


def compare(program, explicit, name, work):
    steps, between, moments = LONG if name == "seikaiha" or name.startswith("fig9") else SHORT
    folder = work / name
    record = [program, "record", name, "--fields", "--quiet", "--out", folder]
    record += ["--steps", str(steps), "--frames", str(steps // between + 1)]
    subprocess.run(record, check=True)
    cloth = np.load(folder / "cloth.npz")
    if cloth["splits"] != 1:
        sys.exit(f"{name}: its explicit steps are split; explicit.c does not do that")
    states = {}
    for file in sorted(folder.glob("state_*.npz")):
        state = np.load(file)
        if int(state["step"]) in [0, *moments]:
            states[int(state["step"])] = {k: state[k] for k in state.files}
    (work / "problem").write_bytes(problem(cloth, states[0], moments))
    subprocess.run([explicit, work / "problem", work / "solution"], check=True)
    shape = (len(moments), 2, *cloth["capacity_free"].shape)
    solution = np.fromfile(work / "solution").reshape(shape)
    v_u = cloth["capacity_free"].astype(float)
    passed = True
    for moment, (free, bound) in zip(moments, solution):
        state = states[moment]
        ours = np.divide(state["free"], v_u, out=np.zeros_like(v_u), where=v_u > 0)
        line = f"| {name} | {moment:,} |"
        for a, b in [(ours, free), (state["bound"], bound)]:
            most, rms = np.abs(a - b).max(), np.sqrt(np.mean((a - b) ** 2))
            line += f" {most / MOST:.2f} | {rms / MOST_RMS:.2f} |"
            passed &= most <= MOST and rms <= MOST_RMS
        print(line, flush=True)
    return passed


def main():
    names = sys.argv[1:] or ["seikaiha", *FIGURES]
    program = build()
    with tempfile.TemporaryDirectory() as work:
        work = Path(work)
        explicit = work / "explicit"
        c = ["gcc", "-O3", "-march=native", "-fopenmp", HERE / "explicit.c", "-o", explicit, "-lm"]
        subprocess.run(c, check=True)
        print("Errors as shares of their bounds: 1/255 of full scale at most, 1/2000 RMS.\n")
        print("| scenario | step | free, largest | free, RMS | bound, largest | bound, RMS |")
        print("|---|---|---|---|---|---|")
        passed = [compare(program, explicit, name, work) for name in names]
    sys.exit(0 if all(passed) else 1)


if __name__ == "__main__":
    main()

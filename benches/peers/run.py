#!/usr/bin/env python3
"""Explicit steps of dyelapse beside the same step in C, Devito, Taichi and NumPy.

    python3 benches/peers/run.py

Needs cargo, gcc and Python with venv; the first run puts the Python packages of requirements.txt
into target/peers. All take turns, three rounds; the best round of each counts. Writes
target/peers/peers.md and peers.png.
"""

import json
import os
import platform
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
WORK = ROOT / "target" / "peers"
PYTHON = WORK / "venv" / "bin" / "python"
ROUNDS = 3
# Steps enough for about a second each.
SIZES = {(800, 600): {"NumPy": 20, "": 400}, (4096, 4096): {"NumPy": 2, "": 12}}


def prepare():
    WORK.mkdir(parents=True, exist_ok=True)
    if not PYTHON.exists():
        venv.create(WORK / "venv", with_pip=True)
        pip = [PYTHON, "-m", "pip", "install", "-q", "-r", HERE / "requirements.txt"]
        subprocess.run(pip, check=True)
    c = ["gcc", "-O3", "-march=native", "-fopenmp", HERE / "step.c", "-o", WORK / "step", "-lm"]
    subprocess.run(c, check=True)
    build = ["cargo", "bench", "--bench", "solvers", "--no-run", "--message-format", "json"]
    lines = subprocess.run(build, check=True, cwd=ROOT, stdout=subprocess.PIPE).stdout.splitlines()
    bench = [json.loads(line) for line in lines]
    bench = [m["executable"] for m in bench if m.get("target", {}).get("name") == "solvers"]
    return {
        "dyelapse": [bench[-1], "--steps"],
        "C": [WORK / "step"],
        "Devito": [PYTHON, HERE / "step_devito.py"],
        "Taichi": [PYTHON, HERE / "step_taichi.py"],
        "NumPy": [PYTHON, HERE / "step_numpy.py"],
    }


def machine():
    name = platform.processor() or platform.machine()
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        name = next((l.split(": ")[1] for l in lines if l.startswith("model name")), name)
    return f"{name}, {os.cpu_count()} cores"


def main():
    programs = prepare()
    best, errors = {}, {}
    for _ in range(ROUNDS):
        for (nx, ny), steps in SIZES.items():
            for name, command in programs.items():
                count = steps.get(name, steps[""])
                command = [*map(str, command), str(nx), str(ny), str(count)]
                out = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
                speed, error = map(float, out.split()[-2:])
                best[name, nx] = max(best.get((name, nx), 0), speed)
                errors[name] = error
                print(f"{nx}x{ny} {name}: {speed:.3f}", file=sys.stderr)
    rows = ["| | " + " | ".join(f"{nx}×{ny}×2" for nx, ny in SIZES) + " | largest error |"]
    rows.append("|---|" + "---:|" * (len(SIZES) + 1))
    for name in programs:
        cells = []
        for nx, _ in SIZES:
            ratio = best["dyelapse", nx] / best[name, nx]
            cells.append(f"{best[name, nx]:.2f} ({ratio:.1f}×)" if name != "dyelapse" else f"**{best[name, nx]:.2f}**")
        rows.append(f"| {name} | " + " | ".join(cells) + f" | {errors[name]:.0e} |")
    note = (
        "Billions of cell updates a second, explicit steps in float32; in brackets how many times as "
        "fast dyelapse is. The error is against double precision after 200 steps. " + machine() + "."
    )
    table = "\n".join(rows) + "\n\n" + note + "\n"
    (WORK / "peers.md").write_text(table)
    print(table)
    plot = WORK / "plot.json"
    plot.write_text(json.dumps([[n, [best[n, nx] for nx, _ in SIZES]] for n in programs]))
    code = (
        "import json,sys,matplotlib; matplotlib.use('Agg'); import matplotlib.pyplot as p\n"
        "d=json.load(open(sys.argv[1])); sizes=sys.argv[3:]\n"
        "f,a=p.subplots(figsize=(7,3.2))\n"
        "for i,s in enumerate(sizes):\n"
        "  b=a.barh([k+0.2-0.4*i for k in range(len(d))],[v[i] for _,v in d],0.38,label=s,color=['#22407a','#9db4d8'][i])\n"
        "  a.bar_label(b,fmt='%.2f',padding=3,fontsize=8)\n"
        "a.set_yticks(range(len(d)),[n for n,_ in d]); a.invert_yaxis(); a.margins(x=0.12)\n"
        "a.set_xlabel('billions of cell updates a second'); a.legend(title='cloth, in cells')\n"
        "[a.spines[s].set_visible(False) for s in ('top','right')]\n"
        "f.tight_layout(); f.savefig(sys.argv[2],dpi=130)\n"
    )
    sizes = [f"{nx}×{ny}×2" for nx, ny in SIZES]
    subprocess.run([PYTHON, "-c", code, plot, WORK / "peers.png", *sizes], check=True)
    print(f"{WORK / 'peers.md'}\n{WORK / 'peers.png'}")


if __name__ == "__main__":
    main()

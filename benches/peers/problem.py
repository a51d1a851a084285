"""The problem that every peer solves: explicit steps of diffusion in two layers of cells.

c[l, y, x] += m·(Σ of five faces of g·(c there − c here)), float32, with the conductances stored:
`e` between x and x+1, `s` between y and y+1, `b` between the layers. Nothing flows over the edge.
"""

import sys
import time

import numpy as np


def make(nx, ny, kind=np.float32):
    i = np.arange(2 * ny * nx).reshape(2, ny, nx)
    c = (i * 7919 % 1000 / 1000).astype(np.float32).astype(kind)
    e = (0.1 + i % 13 * 0.005).astype(np.float32).astype(kind)
    s = (0.1 + i % 7 * 0.005).astype(np.float32).astype(kind)
    e[:, :, -1] = 0
    s[:, -1, :] = 0
    b = np.full((ny, nx), np.float32(0.1), kind)
    m = np.ones((2, ny, nx), kind)
    return c, e, s, b, m


def numpy_step(c, e, s, b, m):
    d = np.zeros_like(c)
    f = e[:, :, :-1] * (c[:, :, 1:] - c[:, :, :-1])
    d[:, :, :-1] += f
    d[:, :, 1:] -= f
    f = s[:, :-1] * (c[:, 1:] - c[:, :-1])
    d[:, :-1] += f
    d[:, 1:] -= f
    f = b * (c[1] - c[0])
    d[0] += f
    d[1] -= f
    d *= m
    d += c
    return d


def report(advance, prepare):
    """Runs `advance(state, steps)`: prints billions of cell updates a second and the error."""
    nx, ny, steps = map(int, sys.argv[1:4])
    small, exact = prepare(200, 150), make(200, 150, np.float64)
    field = exact[0]
    for _ in range(200):
        field = numpy_step(field, *exact[1:])
    error = float(np.abs(advance(small, 200) - field).max())
    del small
    state = prepare(nx, ny)
    advance(state, 2)
    begin = time.perf_counter()
    advance(state, steps)
    print(2 * nx * ny * steps / (time.perf_counter() - begin) / 1e9, error)

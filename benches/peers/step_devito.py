import devito
import numpy as np
from devito import Eq, Function, Grid, Operator, TimeFunction
from problem import make, report

devito.configuration["language"] = "openmp"
devito.configuration["log-level"] = "ERROR"


def prepare(nx, ny):
    c, e, s, b, m = make(nx, ny)
    grid = Grid(shape=(ny, nx))
    y, x = grid.dimensions

    def field(name, values):
        function = Function(name=name, grid=grid, space_order=2)
        function.data[:] = values
        return function

    c = [TimeFunction(name=f"c{l}", grid=grid, space_order=2, time_order=1) for l in range(2)]
    for layer in range(2):
        c[layer].data[:] = make(nx, ny)[0][layer]
    beside = field("b", b)
    equations = []
    for l in range(2):
        h, east, south = c[l], field(f"e{l}", e[l]), field(f"s{l}", s[l])
        hx, hy = x.spacing, y.spacing
        q = (
            east * (h.subs(x, x + hx) - h)
            + east.subs(x, x - hx) * (h.subs(x, x - hx) - h)
            + south * (h.subs(y, y + hy) - h)
            + south.subs(y, y - hy) * (h.subs(y, y - hy) - h)
            + beside * (c[1 - l] - h)
        )
        equations.append(Eq(h.forward, h + field(f"m{l}", m[l]) * q))
    return c, Operator(equations), [0]


def advance(state, steps):
    c, operator, done = state
    operator.apply(time_m=done[0], time_M=done[0] + steps - 1)
    done[0] += steps
    return np.stack([np.array(layer.data[done[0] % 2]) for layer in c])


report(advance, prepare)

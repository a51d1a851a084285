/* The explicit solver in double precision, after docs/fields.md: reads a problem that accuracy.py
   wrote, and writes free and bound dye at every step asked for. Written apart from the engine. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double *fields(size_t n, FILE *file) {
    double *all = malloc(n * sizeof(double));
    if (!all || fread(all, sizeof(double), n, file) != n) {
        fprintf(stderr, "the problem is cut short\n");
        exit(1);
    }
    return all;
}

static double limit(int isotherm, double k, double b, double phi, double v_d) {
    switch (isotherm) {
    case 1: return k * phi;
    case 2: return k * pow(phi, b);
    case 3: return v_d * k * phi / (1 + k * phi);
    default: return 0;
    }
}

int main(int count, char **arguments) {
    if (count < 3) return 2;
    FILE *in = fopen(arguments[1], "rb"), *out = fopen(arguments[2], "wb");
    int64_t head[4];
    if (!in || !out || fread(head, sizeof head, 1, in) != 1) return 2;
    long ny = head[0], nx = head[1], moments = head[2], isotherm = head[3];
    long layer = ny * nx, n = 2 * layer;
    double *numbers = fields(4, in); /* phi0, k, b, D_ab·Δt/Δd² */
    double *steps = fields(moments, in);
    /* G = Δt/Δd²·D_face·min(V_u): east, south, between the layers; V_u, V_d; φ, A, what is held. */
    double *east = fields(n, in), *south = fields(n, in), *beside = fields(layer, in);
    double *v_u = fields(n, in), *v_d = fields(n, in);
    double *phi = fields(n, in), *bound = fields(n, in), *held = fields(n, in);
    double *c = malloc(n * sizeof(double)), *next = calloc(n, sizeof(double));
    for (long i = 0; i < n; i++) c[i] = v_u[i] > 0 ? phi[i] / v_u[i] : 0;
    long step = 0;
    for (long moment = 0; moment < moments; moment++) {
        for (; step < (long)steps[moment]; step++) {
#pragma omp parallel for schedule(static)
            for (long row = 0; row < 2 * ny; row++) {
                long l = row / ny, y = row % ny;
                for (long x = 0; x < nx; x++) {
                    long i = row * nx + x, other = l ? i - layer : i + layer;
                    double flow = 0;
#define FACE(g, j)                                                                                 \
    {                                                                                              \
        double mean = 0.5 * (c[i] + c[j]);                                                         \
        double rho = numbers[0] < 1 && mean > numbers[0] ? numbers[0] / mean : 1;                  \
        flow += (g) * rho * (c[j] - c[i]);                                                         \
    }
                    if (x + 1 < nx) FACE(east[i], i + 1)
                    if (x > 0) FACE(east[i - 1], i - 1)
                    if (y + 1 < ny) FACE(south[i], i + nx)
                    if (y > 0) FACE(south[i - nx], i - nx)
                    FACE(beside[y * nx + x], other)
                    if (!(v_u[i] > 0)) continue;
                    double free_dye = c[i] * v_u[i] + flow;
                    if (isotherm) {
                        double most = fmin(v_d[i], limit(isotherm, numbers[1], numbers[2],
                                                         free_dye, v_d[i]));
                        double gain = fmin(numbers[3] * free_dye, fmax(most - bound[i], 0));
                        bound[i] += gain;
                        free_dye -= gain;
                    }
                    next[i] = isnan(held[i]) ? free_dye / v_u[i] : held[i] / v_u[i];
                }
            }
            double *swap = c;
            c = next;
            next = swap;
        }
        fwrite(c, sizeof(double), n, out);
        fwrite(bound, sizeof(double), n, out);
    }
    return 0;
}

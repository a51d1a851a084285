// The same step in plain C: gcc -O3 -march=native -fopenmp step.c. See problem.py.
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static void step(long nx, long ny, const float *c, float *d, const float *e, const float *s,
                 const float *b, const float *m) {
#pragma omp parallel for collapse(2) schedule(static)
    for (long l = 0; l < 2; l++)
        for (long y = 0; y < ny; y++) {
            const long at = (l * ny + y) * nx;
            const float *restrict r = c + at, *restrict o = c + ((1 - l) * ny + y) * nx;
            const float *restrict up = y ? r - nx : r, *restrict dn = y + 1 < ny ? r + nx : r;
            const float *restrict er = e + at, *restrict sr = s + at;
            const float *restrict su = y ? sr - nx : sr, *restrict br = b + y * nx;
            const float *restrict mr = m + at;
            float *restrict w = d + at;
            w[0] = r[0] + mr[0] * (er[0] * (r[1] - r[0]) + su[0] * (up[0] - r[0]) +
                                   sr[0] * (dn[0] - r[0]) + br[0] * (o[0] - r[0]));
            for (long x = 1; x < nx - 1; x++)
                w[x] = r[x] + mr[x] * (er[x - 1] * (r[x - 1] - r[x]) + er[x] * (r[x + 1] - r[x]) +
                                       su[x] * (up[x] - r[x]) + sr[x] * (dn[x] - r[x]) +
                                       br[x] * (o[x] - r[x]));
            const long x = nx - 1;
            w[x] = r[x] + mr[x] * (er[x - 1] * (r[x - 1] - r[x]) + su[x] * (up[x] - r[x]) +
                                   sr[x] * (dn[x] - r[x]) + br[x] * (o[x] - r[x]));
        }
}

static float *field(long n) { return malloc(sizeof(float) * n); }

// Seconds for the steps; the last concentrations are kept in `keep` if there is any.
static double run(long nx, long ny, long steps, float *keep) {
    const long n = 2 * nx * ny;
    float *c = field(n), *d = field(n), *e = field(n), *s = field(n), *b = field(n / 2),
          *m = field(n);
#pragma omp parallel for
    for (long i = 0; i < n; i++) {
        c[i] = (i * 7919 % 1000) / 1000.0;
        d[i] = 0;
        e[i] = i % nx == nx - 1 ? 0 : 0.1 + i % 13 * 0.005;
        s[i] = i / nx % ny == ny - 1 ? 0 : 0.1 + i % 7 * 0.005;
        m[i] = 1;
        if (i < n / 2) b[i] = 0.1f;
    }
    struct timespec from, to;
    clock_gettime(CLOCK_MONOTONIC, &from);
    for (long t = 0; t < steps; t++) {
        step(nx, ny, c, d, e, s, b, m);
        float *swap = c;
        c = d;
        d = swap;
    }
    clock_gettime(CLOCK_MONOTONIC, &to);
    for (long i = 0; keep && i < n; i++) keep[i] = c[i];
    free(c), free(d), free(e), free(s), free(b), free(m);
    return to.tv_sec - from.tv_sec + 1e-9 * (to.tv_nsec - from.tv_nsec);
}

// The same in double precision, as plainly as possible.
static double error_after(long nx, long ny, long steps, const float *against) {
    const long n = 2 * nx * ny;
    double *c = malloc(8 * n), *d = malloc(8 * n), worst = 0;
    for (long i = 0; i < n; i++) c[i] = (float)((i * 7919 % 1000) / 1000.0);
    for (long t = 0; t < steps; t++) {
        for (long i = 0; i < n; i++) {
            const long x = i % nx, y = i / nx % ny, o = i < n / 2 ? i + n / 2 : i - n / 2;
            double q = (double)0.1f * (c[o] - c[i]);
            if (x + 1 < nx) q += (double)(float)(0.1 + i % 13 * 0.005) * (c[i + 1] - c[i]);
            if (x > 0) q += (double)(float)(0.1 + (i - 1) % 13 * 0.005) * (c[i - 1] - c[i]);
            if (y + 1 < ny) q += (double)(float)(0.1 + i % 7 * 0.005) * (c[i + nx] - c[i]);
            if (y > 0) q += (double)(float)(0.1 + (i - nx) % 7 * 0.005) * (c[i - nx] - c[i]);
            d[i] = c[i] + q;
        }
        double *swap = c;
        c = d;
        d = swap;
    }
    for (long i = 0; i < n; i++) worst = fmax(worst, fabs(against[i] - c[i]));
    free(c), free(d);
    return worst;
}

int main(int argc, char **argv) {
    if (argc != 4) return 2;
    const long nx = atol(argv[1]), ny = atol(argv[2]), steps = atol(argv[3]);
    float *small = field(2 * 200 * 150);
    run(200, 150, 200, small);
    const double error = error_after(200, 150, 200, small);
    run(nx, ny, 2, NULL);
    printf("%g %g\n", 2e-9 * nx * ny * steps / run(nx, ny, steps, NULL), error);
    return 0;
}

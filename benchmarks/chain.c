/* The peer of the compiled kernel, written by hand: the chain of Qian et al. (2014) with dead zone, square-root flow and
   quadratic damping, classical Runge-Kutta, sixteen systems side by side in vectors of four. */

#include <math.h>

typedef double v4 __attribute__((vector_size(32)));
typedef long long m4 __attribute__((vector_size(32)));

static inline v4 pick(m4 mask, v4 a, v4 b) { return (v4)((mask & (m4)a) | (~mask & (m4)b)); }
static inline v4 root(v4 x) { return (v4){sqrt(x[0]), sqrt(x[1]), sqrt(x[2]), sqrt(x[3])}; }
static inline v4 all(double x) { return (v4){x, x, x, x}; }

/* Parameters of four systems. */
typedef struct { v4 Kp, Ti, Zi, Cl, A, Ki, c, k, Mi, h, r, c2; } P4;

static inline void rates(const P4 *p, v4 u, v4 q, v4 P, v4 v, v4 x, v4 *dq, v4 *dP, v4 *dv) {
    v4 e = p->Kp * (u - x), zero = all(0.0);
    v4 w = q - pick(q > p->h, p->h, pick(q < -p->h, -p->h, q));
    v4 s = pick(w > zero, all(1.0), pick(w < zero, all(-1.0), zero));
    v4 left = all(1.0) - s * P * p->r;
    v4 Q = p->Zi * w * root(pick(left > zero, left, zero));
    v4 size = pick(v >= zero, v, -v);
    *dq = (e - q) * p->Ti;
    *dP = (Q - p->Cl * P - p->A * v) * p->Ki;
    *dv = (p->A * P - p->c * v - p->c2 * v * size - p->k * x) * p->Mi;
}

/* values: 12 rows of 16; states: 4 rows of 16; u: n + 1 commands; out: n rows of 16. */
void advance(const double *values, double *states, const double *u, long n, double dt, double *out) {
    P4 p[4];
    v4 q[4], P[4], v[4], x[4];
    for (int g = 0; g < 4; g++) {
        v4 *row = (v4 *)&p[g];
        for (int i = 0; i < 12; i++) row[i] = *(const v4 *)(values + 16 * i + 4 * g);
        q[g] = *(v4 *)(states + 4 * g);
        P[g] = *(v4 *)(states + 16 + 4 * g);
        v[g] = *(v4 *)(states + 32 + 4 * g);
        x[g] = *(v4 *)(states + 48 + 4 * g);
    }
    v4 half = all(0.5 * dt), whole = all(dt), sixth = all(dt / 6), two = all(2.0);
    for (long k = 0; k < n; k++) {
        v4 u0 = all(u[k]), u1 = all(0.5 * (u[k] + u[k + 1])), u2 = all(u[k + 1]);
        for (int g = 0; g < 4; g++) {
            v4 a1, b1, c1, a2, b2, c2, a3, b3, c3, a4, b4, c4;
            *(v4 *)(out + 16 * k + 4 * g) = x[g];
            v4 d1 = v[g];
            rates(&p[g], u0, q[g], P[g], v[g], x[g], &a1, &b1, &c1);
            v4 d2 = v[g] + half * c1;
            rates(&p[g], u1, q[g] + half * a1, P[g] + half * b1, d2, x[g] + half * d1, &a2, &b2, &c2);
            v4 d3 = v[g] + half * c2;
            rates(&p[g], u1, q[g] + half * a2, P[g] + half * b2, d3, x[g] + half * d2, &a3, &b3, &c3);
            v4 d4 = v[g] + whole * c3;
            rates(&p[g], u2, q[g] + whole * a3, P[g] + whole * b3, d4, x[g] + whole * d3, &a4, &b4, &c4);
            q[g] += sixth * (a1 + two * (a2 + a3) + a4);
            P[g] += sixth * (b1 + two * (b2 + b3) + b4);
            v[g] += sixth * (c1 + two * (c2 + c3) + c4);
            x[g] += sixth * (d1 + two * (d2 + d3) + d4);
        }
    }
}

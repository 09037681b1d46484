"""The C of an actuator of a bench: its exact simulation with derivatives, as in :mod:`ident.bench.exact_response`."""

from __future__ import annotations

SIMULATION = r"""typedef struct {
    double T, B, I0, kp, friction, still, full, most;
    double pieces[2][SERVOIDENT_NODES][4];
    double gains[4][3], gains_T[4][3];
    double start[2], start_slope[2], start_nodes[2][SERVOIDENT_NODES], speeds[2][SERVOIDENT_NODES];
    double step;
} servoident_model;

/* the link and the current behind the lag and the play, with derivatives by T, B, I0, kp, dPfr and the speeds */
typedef struct {
    double x, q, w, qT, wT, wB, wI, last, dx[SERVOIDENT_VALUES];
    int contact, begun;
} servoident_state;

static const int servoident_divided[4] = {1, 2, 8, 32};

static inline double servoident_clip(double x, double low, double high)
{
    return x < low ? low : (x > high ? high : x);
}

static inline void servoident_gains(double T, double step, double out[3])
{
    if (1e-3 * step > T) {
        out[0] = 0.0; out[1] = 0.0; out[2] = 1.0;
        return;
    }
    out[0] = exp(-step / T);
    out[2] = 1.0 - (1.0 - out[0]) * T / step;
    out[1] = (1.0 - out[0]) - out[2];
}

static inline double servoident_piece(double t, double width, const double c[4], double *slope)
{
    double within = t < width ? t : width;
    *slope = c[1] + within * (2.0 * c[2] + 3.0 * within * c[3]);
    return c[0] + within * (c[1] + within * (c[2] + within * c[3])) + (t - within) * *slope;
}

static inline double servoident_speed(const servoident_model *m, int side, double a, double *slope, int *piece,
                                      double *place)
{
    int i = SERVOIDENT_NODES - 1;
    while (i > 0 && a < servoident_nodes[i]) i--;
    *piece = i;
    *place = a - servoident_nodes[i];
    return servoident_piece(*place, servoident_nodes[i + 1] - servoident_nodes[i], m->pieces[side][i], slope);
}

/* by how much the speed grows where the speed at node j grows by its own size */
static inline double servoident_node(const servoident_model *m, int side, int j, int piece, double place)
{
    double slope, width = servoident_nodes[piece + 1] - servoident_nodes[piece];
    return m->speeds[side][j] * servoident_piece(place, width, servoident_basis[j][piece], &slope);
}

static inline int servoident_kind(const servoident_model *m, double u)
{
    double a = fabs(u);
    int kind;
    if (a <= m->still || m->full <= m->still) return 0;
    kind = a > m->full ? 2 : 1;
    return u > 0.0 ? kind : -kind;
}

static inline void servoident_set(servoident_model *m, const double *v, double step)
{
    int side, i, j, k;
    double slope, place, above[3], below[3], stride = 1e-6 * v[0];
    m->T = v[0]; m->B = v[1]; m->I0 = v[2]; m->kp = v[3]; m->friction = v[4]; m->step = step;
    m->still = v[4] / v[3];
    m->full = SERVOIDENT_SUPPLY / v[3];
    slope = 1.0 - v[4] / SERVOIDENT_SUPPLY;
    m->most = sqrt(slope > 0.0 ? slope : 0.0);
    for (i = 0; i < 4; i++) {
        double h = step / servoident_divided[i];
        servoident_gains(v[0], h, m->gains[i]);
        servoident_gains(v[0] + stride, h, above);
        servoident_gains(v[0] - stride, h, below);
        for (j = 0; j < 3; j++) m->gains_T[i][j] = (above[j] - below[j]) / (2.0 * stride);
    }
    memset(m->pieces, 0, sizeof m->pieces);
    for (side = 0; side < 2; side++) {
        for (j = 0; j < SERVOIDENT_NODES; j++) {
            m->speeds[side][j] = side ? -v[5 + SERVOIDENT_NODES + j] : v[5 + j];
            for (i = 0; i < SERVOIDENT_NODES; i++)
                for (k = 0; k < 4; k++) m->pieces[side][i][k] += m->speeds[side][j] * servoident_basis[j][i][k];
        }
        if (m->still > 0.0) {
            m->start[side] = servoident_speed(m, side, m->still, &slope, &i, &place) / sqrt(m->still);
            m->start_slope[side] = slope / sqrt(m->still) - 0.5 * m->start[side] / m->still;
            for (j = 0; j < SERVOIDENT_NODES; j++)
                m->start_nodes[side][j] = servoident_node(m, side, j, i, place) / sqrt(m->still);
        }
    }
}

/* a part of a sample: the lag, the play, and the way of the link; see the equations of the bench's model */
static inline void servoident_part(const servoident_model *m, servoident_state *s, int way, int part, int simpson,
                                   double first, double rise, int sloped)
{
    const double *g = m->gains[way];
    double h = m->step / servoident_divided[way], B = m->B, still = m->still;
    double u0 = s->w - m->I0, uT0 = s->wT, uB0 = s->wB, uI0 = s->wI - 1.0, last = s->q, last_T = s->qT;
    double u1, a0, a1, sign, f0 = 0.0, f1 = 0.0, s0 = 0.0, s1 = 0.0, t0 = 0.0, t1 = 0.0;
    double W0 = 0.0, W1 = 0.0, Ws = 0.0, by0 = 0.0, by1 = 0.0, by_still = 0.0, by_friction = 0.0;
    int pushed = s->w == s->q - B ? 1 : (s->w == s->q + B ? -1 : 0);
    int kind0, kind1, side, p0 = 0, p1 = 0, j;
    if (sloped)
        s->qT = g[0] * s->qT + m->gains_T[way][0] * s->q + m->gains_T[way][1] * first
              + m->gains_T[way][2] * (first + rise);
    s->q = g[0] * s->q + g[1] * first + g[2] * (first + rise);
    if ((first - last) * (first + rise - s->q) < 0.0) { /* the lagged current turns within the part */
        double slope = rise / h;
        double share = servoident_clip(m->T * log((last - first + slope * m->T) / (slope * m->T)) / h, 0.0, 1.0);
        double peak = first + share * rise, peak_T = last_T + share * (s->qT - last_T);
        if (peak - B > s->w) {
            s->w = peak - B; s->wT = peak_T; s->wB = -1.0; s->wI = 0.0;
        } else if (peak + B < s->w) {
            s->w = peak + B; s->wT = peak_T; s->wB = 1.0; s->wI = 0.0;
        }
    }
    if (s->q - B > s->w) {
        s->w = s->q - B; s->wT = s->qT; s->wB = -1.0; s->wI = 0.0;
    } else if (s->q + B < s->w) {
        s->w = s->q + B; s->wT = s->qT; s->wB = 1.0; s->wI = 0.0;
    }
    u1 = s->w - m->I0;
    kind0 = servoident_kind(m, u0);
    kind1 = servoident_kind(m, u1);
    if (!kind0 && !kind1) return;
    sign = kind0 + kind1 > 0 || (kind0 + kind1 == 0 && kind1 > 0) ? 1.0 : -1.0;
    if (kind0 * kind1 < 0) {
        kind0 = 0;
        u0 = 0.0;
    }
    side = sign > 0.0 ? 0 : 1;
    a0 = sign * u0;
    a1 = sign * u1;
    if (kind0) f0 = servoident_speed(m, side, a0, &s0, &p0, &t0);
    if (kind1) f1 = servoident_speed(m, side, a1, &s1, &p1, &t1);
    if (abs(kind0) == 2 && abs(kind1) == 2) {
        double share = !simpson ? 0.5 : (part == 0 ? 1.0 / 3.0 : 2.0 / 3.0);
        W0 = h * share * m->most;
        W1 = h * (1.0 - share) * m->most;
        by0 = W0 * s0;
        by1 = W1 * s1;
        by_friction = -0.5 / (SERVOIDENT_SUPPLY * m->most * m->most) * (W0 * f0 + W1 * f1);
    } else if (abs(kind0) + abs(kind1) == 3) {
        int end;
        for (end = 0; end < 2; end++) {
            double a = end ? a1 : a0, f = end ? f1 : f0, f_slope = end ? s1 : s0;
            int top = abs(end ? kind1 : kind0) == 2;
            double root = top ? m->most : sqrt(1.0 - still / a), slope = 0.5 * h * f_slope * root;
            if (top) {
                by_friction -= 0.25 * h * f / (SERVOIDENT_SUPPLY * m->most);
            } else {
                slope += 0.25 * h * f * still / (a * a * root);
                by_still -= 0.25 * h * f / (a * root);
            }
            if (end) {
                W1 = 0.5 * h * root;
                by1 = slope;
            } else {
                W0 = 0.5 * h * root;
                by0 = slope;
            }
        }
    } else if (kind0 && kind1) {
        double r0 = sqrt(a0 - still), r1 = sqrt(a1 - still), root0 = sqrt(a0), root1 = sqrt(a1), r = r0 + r1;
        double A = 2.0 * (3.0 * r0 * r0 * r0 + 6.0 * r0 * r0 * r1 + 4.0 * r0 * r1 * r1 + 2.0 * r1 * r1 * r1)
                 / (15.0 * r * r);
        double Z = 2.0 * (3.0 * r1 * r1 * r1 + 6.0 * r1 * r1 * r0 + 4.0 * r1 * r0 * r0 + 2.0 * r0 * r0 * r0)
                 / (15.0 * r * r);
        double over = h / (15.0 * r * r * r), both = 2.0 * r0 * r0 + 6.0 * r0 * r1 + 2.0 * r1 * r1;
        double A0 = 3.0 * r0 * r0 + 9.0 * r0 * r1 + 8.0 * r1 * r1, Z1 = 3.0 * r1 * r1 + 9.0 * r0 * r1 + 8.0 * r0 * r0;
        double e0 = f0 / root0, e1 = f1 / root1;
        W0 = h * A / root0;
        W1 = h * Z / root1;
        by0 = W0 * (s0 - 0.5 * f0 / a0) + over * (e0 * A0 + e1 * both);
        by1 = W1 * (s1 - 0.5 * f1 / a1) + over * (e0 * both + e1 * Z1);
        by_still = -over * (e0 * (A0 + both) + e1 * (both + Z1));
    } else { /* the link starts or stops within the part */
        double inner = kind1 ? a0 : a1, outer = kind1 ? a1 : a0, f = kind1 ? f1 : f0, f_slope = kind1 ? s1 : s0;
        double d = outer - still, gap = outer - inner, r = sqrt(d), root = sqrt(outer);
        double W = h * 0.4 * d * r / gap / root, e = h * (4.0 * m->start[side] + 6.0 * f / root) / 15.0;
        double by_outer = W * (f_slope - 0.5 * f / outer) + e * (1.5 * r / gap - d * r / (gap * gap));
        double by_inner = e * d * r / (gap * gap);
        Ws = h * 4.0 / 15.0 * d * r / gap;
        by_still = Ws * m->start_slope[side] - e * 1.5 * r / gap;
        if (kind1) {
            W1 = W; by0 = by_inner; by1 = by_outer;
        } else {
            W0 = W; by0 = by_outer; by1 = by_inner;
        }
    }
    s->x += sign * (W0 * f0 + W1 * f1 + Ws * m->start[side]);
    if (!simpson && pushed && s->w == s->q - pushed * B) s->x -= (by0 + by1) * h / 12.0 * (rise - s->q + last) / m->T;
    if (!sloped) return;
    s->dx[0] += by0 * uT0 + by1 * s->wT;
    s->dx[1] += by0 * uB0 + by1 * s->wB;
    s->dx[2] += by0 * uI0 + by1 * (s->wI - 1.0);
    s->dx[3] -= sign * by_still * m->friction / (m->kp * m->kp);
    s->dx[4] += sign * (by_still / m->kp + by_friction);
    for (j = 0; j < SERVOIDENT_NODES; j++) {
        double more = Ws * m->start_nodes[side][j];
        if (kind0) more += W0 * servoident_node(m, side, j, p0, t0);
        if (kind1) more += W1 * servoident_node(m, side, j, p1, t1);
        s->dx[5 + side * SERVOIDENT_NODES + j] += sign * more;
    }
}

/* the next sample of a record; the first one where the state is new */
static inline void servoident_advance(const servoident_model *m, servoident_state *s, double current, double position,
                                      int held, int sloped)
{
    double i0 = s->last, i1 = held ? s->last : current, im, qm, qe, wm, we, least, rise, moved;
    const double *g = m->gains[1];
    int cm, ce, k0, km, ke, reversal, quiet, kinked, far, way = 1, simpson = 0, part, parts;
    s->last = current;
    if (!s->begun) {
        s->begun = 1;
        s->x = position;
        s->q = current;
        s->w = servoident_clip(m->I0, current - m->B, current + m->B);
        if (s->w == m->I0) s->wI = 1.0;
        else s->wB = s->w > current ? 1.0 : -1.0;
        return;
    }
    im = 0.5 * (i0 + i1);
    qm = g[0] * s->q + g[1] * i0 + g[2] * im;
    qe = g[0] * qm + g[1] * im + g[2] * i1;
    wm = servoident_clip(s->w, qm - m->B, qm + m->B);
    we = servoident_clip(wm, qe - m->B, qe + m->B);
    cm = wm > s->w ? 1 : (wm < s->w ? -1 : 0);
    ce = we > wm ? 1 : (we < wm ? -1 : 0);
    k0 = servoident_kind(m, s->w - m->I0);
    km = servoident_kind(m, wm - m->I0);
    ke = servoident_kind(m, we - m->I0);
    reversal = (i0 - s->q) * (i1 - qe) < 0.0;
    quiet = !k0 && !km && !ke;
    kinked = !(k0 == ke && km == k0) && (abs(k0) == 2 || abs(km) == 2 || abs(ke) == 2 || k0 * ke < 0);
    least = fabs(s->w - m->I0);
    if (fabs(wm - m->I0) < least) least = fabs(wm - m->I0);
    if (fabs(we - m->I0) < least) least = fabs(we - m->I0);
    if (least < m->still) least = m->still;
    moved = fabs(wm - s->w) > fabs(we - wm) ? fabs(wm - s->w) : fabs(we - wm);
    far = moved > 0.25 * least;
    if (!quiet && (kinked || (far && !(abs(k0) == 2 && k0 == ke && km == k0)))) way = 3;
    else if (reversal || ((cm != s->contact || ce != s->contact) && !(quiet && !cm && !ce)))
        way = 2;
    else if (quiet) way = 0;
    else simpson = k0 == ke && abs(k0) == 2;
    s->contact = ce;
    parts = servoident_divided[way];
    rise = (i1 - i0) / parts;
    for (part = 0; part < parts; part++) servoident_part(m, s, way, part, simpson, i0 + part * rise, rise, sloped);
}
"""

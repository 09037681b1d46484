"""The C of an identification on a control unit: C99, fixed memory, no heap, no library beside the mathematical one."""

from __future__ import annotations

from string import Template

CODE = Template(r"""/* The identification of a servo actuator on a bench: its values from its records, by least squares.
 *
 *     servoident_identification found;                      fixed memory, 15 kB
 *     int ok = servoident_identify(&found, read, context);
 *     found.sheet[SERVOIDENT_DEAD_SPACE]                    and so on, SI; currents in rated currents
 *
 * `read(context, record, sample, out)` gives out[0] current (rated currents), out[1] position (m) and out[2] pressure
 * difference A - B (Pa) of a sample. It is called for all samples of each record, in order, some twenty times:
$order
 *
 * The search begins at servoident_begin, or at found.values where found.begun is 1. servoident_identify returns 1, or 0
 * where no step of the search lowers the residual before it has converged.
 */
#ifndef SERVOIDENT_IDENTIFICATION_H
#define SERVOIDENT_IDENTIFICATION_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SERVOIDENT_RECORDS $records
#define SERVOIDENT_NODES $nodes
#define SERVOIDENT_VALUES (5 + 2 * SERVOIDENT_NODES)
#define SERVOIDENT_ROWS (SERVOIDENT_VALUES + 1) /* derivatives of the values, then the residual */
#define SERVOIDENT_SUPPLY $supply /* Pa */
#define SERVOIDENT_CONVERTER $converter /* m, its step; 0: none */
#define SERVOIDENT_QUANTITIES $quantities
$names

typedef void (*servoident_read)(void *context, int record, long sample, double out[3]);

typedef struct {
    long samples;
    int first_part, parts, held, positions;
    double step, extra, pressure, reach; /* s; m; Pa, 0: none; largest current */
} servoident_record;

static const servoident_record servoident_records[SERVOIDENT_RECORDS] = {
    $table
};
static const long servoident_parts[$parts][2] = {
    $part_ends
};
static const double servoident_nodes[SERVOIDENT_NODES + 1] = {$node_places};
static const double servoident_basis[SERVOIDENT_NODES][SERVOIDENT_NODES][4] = {
    $basis
};
/* T, B, I0, kp, dPfr, speeds forth, speeds back */
static const double servoident_begin[SERVOIDENT_VALUES] = {$begin};
/* those whose movements say how far each reading of a position may be off */
static const double servoident_usual[SERVOIDENT_VALUES] = {$moving};

/* sums of weighted products about the mean */
typedef struct {
    double weight, mean[SERVOIDENT_ROWS], products[SERVOIDENT_ROWS][SERVOIDENT_ROWS];
} servoident_sums;

typedef struct {
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

typedef struct {
    long sample, before, behind;
    double fastest, change, row[SERVOIDENT_ROWS]; /* fastest below 0: not known yet */
} servoident_reading;

typedef struct {
    double values[SERVOIDENT_VALUES], sheet[SERVOIDENT_QUANTITIES];
    int begun, steps;
    double error;
    double normal[SERVOIDENT_ROWS][SERVOIDENT_ROWS], tried[SERVOIDENT_ROWS][SERVOIDENT_ROWS];
    servoident_sums positions, pressures;
    servoident_model model, weighing;
    servoident_state state, moving;
    servoident_reading waiting[8];
    double moved[8];
} servoident_identification;

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
        way = quiet || moved < 1e-3 ? 2 : 3;
    else if (quiet) way = 0;
    else simpson = k0 == ke && abs(k0) == 2;
    s->contact = ce;
    parts = servoident_divided[way];
    rise = (i1 - i0) / parts;
    for (part = 0; part < parts; part++) servoident_part(m, s, way, part, simpson, i0 + part * rise, rise, sloped);
}

static inline void servoident_add(servoident_sums *sums, const double *row, double weight)
{
    double off[SERVOIDENT_ROWS], share;
    int i, j;
    sums->weight += weight;
    share = weight / sums->weight;
    for (i = 0; i < SERVOIDENT_ROWS; i++) {
        off[i] = row[i] - sums->mean[i];
        sums->mean[i] += share * off[i];
    }
    for (i = 0; i < SERVOIDENT_ROWS; i++)
        for (j = 0; j <= i; j++) sums->products[i][j] += weight * (1.0 - share) * off[i] * off[j];
}

static inline void servoident_flush(servoident_sums *sums, double normal[SERVOIDENT_ROWS][SERVOIDENT_ROWS])
{
    int i, j;
    for (i = 0; i < SERVOIDENT_ROWS; i++)
        for (j = 0; j <= i; j++) normal[i][j] += sums->products[i][j];
    memset(sums, 0, sizeof *sums);
}

/* the deviation of a reading at a change where the link moves so many steps in a sample */
static inline double servoident_in_steps(double moved)
{
    double f = moved - floor(moved), g = 1.0 - f;
    return sqrt((moved < 1.0 ? f * f : g * g * g + f * f * f) / 12.0);
}

/* take the readings whose surroundings are known by sample k; at the end of a record all */
static inline int servoident_taken(servoident_identification *id, const servoident_record *r, int *count, long k,
                                   int end, int part)
{
    int n;
    for (n = 0; n < *count; n++) { /* the largest movement in a sample around it */
        servoident_reading *one = &id->waiting[n];
        long i;
        if (one->fastest >= 0.0 || (one->sample + 3 > k && !end)) continue;
        one->fastest = 0.0;
        for (i = one->sample - 3; i <= one->sample + 3 && i <= k; i++)
            if (i >= 0 && id->moved[i % 8] > one->fastest) one->fastest = id->moved[i % 8];
    }
    while (*count && (end || (id->waiting[0].sample + 3 <= k && id->waiting[0].behind))) {
        servoident_reading *now = &id->waiting[0];
        double known = 0.0, deviation;
        long gap = now->before;
        if (SERVOIDENT_CONVERTER > 0.0) {
            double fastest = now->fastest, spacing;
            if (now->behind && (!gap || now->behind < gap)) gap = now->behind;
            spacing = gap ? now->change / gap : 0.0;
            if (spacing > fastest) fastest = spacing;
            known = SERVOIDENT_CONVERTER * servoident_in_steps(fastest / SERVOIDENT_CONVERTER);
        }
        deviation = hypot(known, r->extra);
        while (part < r->parts && now->sample >= servoident_parts[r->first_part + part][1]) {
            servoident_flush(&id->positions, id->tried);
            part++;
        }
        if (part < r->parts && now->sample > servoident_parts[r->first_part + part][0])
            servoident_add(&id->positions, now->row, 1.0 / (deviation * deviation));
        memmove(id->waiting, id->waiting + 1, sizeof id->waiting - sizeof id->waiting[0]);
        --*count;
    }
    return part;
}

/* derivatives along the axes of the search: of logarithms, of the zero shift in hundredths of the rated current */
static inline void servoident_scaled(const servoident_identification *id, const servoident_record *r, double *row)
{
    int i, side;
    row[0] *= id->model.T;
    row[1] *= id->model.B;
    row[2] *= 1e-2;
    row[3] *= id->model.kp;
    row[4] *= id->model.friction;
    for (side = 0; side < 2; side++)
        for (i = 2; i < SERVOIDENT_NODES; i++)
            if (r->reach + fabs(id->model.I0) <= servoident_nodes[i - 1]) row[5 + side * SERVOIDENT_NODES + i] = 0.0;
}

static inline void servoident_pass(servoident_identification *id, const double *values, int record,
                                   servoident_read read, void *context)
{
    const servoident_record *r = &servoident_records[record];
    double sample[3], before[SERVOIDENT_ROWS], row[SERVOIDENT_ROWS], seen = 0.0, stood = 0.0;
    long k, changed = -1;
    int count = 0, part = 0, i, tells = 0;
    servoident_set(&id->model, values, r->step);
    servoident_set(&id->weighing, servoident_usual, r->step);
    memset(&id->state, 0, sizeof id->state);
    memset(&id->moving, 0, sizeof id->moving);
    memset(&id->positions, 0, sizeof id->positions);
    memset(&id->pressures, 0, sizeof id->pressures);
    memset(id->moved, 0, sizeof id->moved);
    memset(before, 0, sizeof before);
    for (k = 0; k < r->samples; k++) {
        read(context, record, k, sample);
        servoident_advance(&id->model, &id->state, sample[0], sample[1], r->held, 1);
        memcpy(row, id->state.dx, sizeof id->state.dx);
        row[SERVOIDENT_VALUES] = id->state.x;
        if (r->positions) {
            if (SERVOIDENT_CONVERTER > 0.0) {
                servoident_advance(&id->weighing, &id->moving, sample[0], sample[1], r->held, 0);
                id->moved[k % 8] = k ? fabs(id->moving.x - stood) : 0.0;
                stood = id->moving.x;
                tells = k && fabs(sample[1] - seen) > 1e-6 * SERVOIDENT_CONVERTER;
            } else {
                tells = k > 0;
            }
            if (tells) {
                servoident_reading *now = &id->waiting[count++];
                double share = SERVOIDENT_CONVERTER > 0.0 ? 0.5 : 0.0;
                now->sample = k;
                now->fastest = -1.0;
                now->before = changed < 0 ? 0 : k - changed;
                now->behind = SERVOIDENT_CONVERTER > 0.0 ? 0 : 1;
                now->change = fabs(sample[1] - seen);
                if (count > 1) id->waiting[count - 2].behind = k - changed;
                changed = k;
                for (i = 0; i < SERVOIDENT_ROWS; i++) now->row[i] = share * before[i] + (1.0 - share) * row[i];
                now->row[SERVOIDENT_VALUES] -= share * seen + (1.0 - share) * sample[1];
                servoident_scaled(id, r, now->row);
            }
            part = servoident_taken(id, r, &count, k, 0, part);
            memcpy(before, row, sizeof row);
            seen = sample[1];
        }
        if (r->pressure > 0.0) {
            double u = id->state.w - id->model.I0, most = id->model.kp * fabs(u);
            if (most > SERVOIDENT_SUPPLY) most = SERVOIDENT_SUPPLY;
            memset(row, 0, sizeof row);
            if (most <= id->model.friction) {
                row[0] = id->model.kp * id->state.wT;
                row[1] = id->model.kp * id->state.wB;
                row[2] = id->model.kp * (id->state.wI - 1.0);
                row[3] = u;
                row[SERVOIDENT_VALUES] = id->model.kp * u - sample[2];
            } else {
                row[4] = u > 0.0 ? 1.0 : -1.0;
                row[SERVOIDENT_VALUES] = row[4] * id->model.friction - sample[2];
            }
            servoident_scaled(id, r, row);
            for (i = 0; i < r->parts; i++) {
                const long *ends = servoident_parts[r->first_part + i];
                if (k >= ends[0] && k < ends[1]) servoident_add(&id->pressures, row, 1.0 / (r->pressure * r->pressure));
                if (k + 1 == ends[1]) servoident_flush(&id->pressures, id->tried);
            }
        }
    }
    servoident_taken(id, r, &count, r->samples - 1, 1, part);
    servoident_flush(&id->positions, id->tried);
}

/* the sum of squares, and the products of derivatives and residual in id->tried */
static inline double servoident_sum(servoident_identification *id, const double *values, servoident_read read,
                                    void *context)
{
    int record;
    memset(id->tried, 0, sizeof id->tried);
    for (record = 0; record < SERVOIDENT_RECORDS; record++) servoident_pass(id, values, record, read, context);
    return id->tried[SERVOIDENT_VALUES][SERVOIDENT_VALUES];
}

/* a step of Levenberg and Marquardt from id->normal, and by how much it is to lower the sum of squares */
static inline double servoident_step_of(servoident_identification *id, double damping, double *step)
{
    int n = SERVOIDENT_VALUES, i, j, k;
    double scale[SERVOIDENT_VALUES], (*L)[SERVOIDENT_ROWS] = id->tried, largest = 1e-300, promised = 0.0;
    for (i = 0; i < n; i++)
        if (id->normal[i][i] > largest) largest = id->normal[i][i];
    for (i = 0; i < n; i++) scale[i] = sqrt(id->normal[i][i] > 1e-12 * largest ? id->normal[i][i] : 1e-12 * largest);
    for (i = 0; i < n; i++) {
        for (j = 0; j <= i; j++) {
            double sum = i == j ? 1.0 + damping + 1e-12 : id->normal[i][j] / scale[i] / scale[j];
            for (k = 0; k < j; k++) sum -= L[i][k] * L[j][k];
            L[i][j] = i == j ? sqrt(sum > 1e-300 ? sum : 1e-300) : sum / L[j][j];
        }
    }
    for (i = 0; i < n; i++) {
        step[i] = -id->normal[n][i] / scale[i];
        for (k = 0; k < i; k++) step[i] -= L[i][k] * step[k];
        step[i] /= L[i][i];
    }
    for (i = n - 1; i >= 0; i--) {
        for (k = i + 1; k < n; k++) step[i] -= L[k][i] * step[k];
        step[i] /= L[i][i];
    }
    for (i = 0; i < n; i++) step[i] = servoident_clip(step[i] / scale[i], -0.7, 0.7);
    for (i = 0; i < n; i++) {
        double along = 0.0;
        for (j = 0; j < n; j++) along += step[j] * (j <= i ? id->normal[i][j] : id->normal[j][i]);
        promised -= step[i] * (2.0 * id->normal[n][i] + along);
    }
    return promised;
}

static inline void servoident_moved(const double *from, const double *step, double *to)
{
    int i;
    for (i = 0; i < SERVOIDENT_VALUES; i++) to[i] = i == 2 ? from[i] + 1e-2 * step[i] : from[i] * exp(step[i]);
}

static inline void servoident_sheet(servoident_identification *id)
{
    double sums[5] = {0.0, 0.0, 0.0, 0.0, 0.0}, through[2][2] = {{0.0, 0.0}, {0.0, 0.0}}, full = 0.0, worst = 0.0;
    double slope, place, gain, offset, mean, *out = id->sheet;
    int i, side, piece, pass;
    servoident_set(&id->model, id->values, 1e-3);
    for (pass = 0; pass < 2; pass++) {
        gain = pass ? (sums[0] * sums[4] - sums[1] * sums[2]) / (sums[0] * sums[3] - sums[1] * sums[1]) : 0.0;
        offset = pass ? (sums[2] - gain * sums[1]) / sums[0] : 0.0;
        for (i = 0; i <= 200; i++) {
            double u = (i - 100) / 100.0 * servoident_nodes[SERVOIDENT_NODES], v = 0.0;
            side = u < 0.0;
            if (i != 100) v = servoident_speed(&id->model, side, fabs(u), &slope, &piece, &place) * (side ? -1.0 : 1.0);
            if (pass) {
                if (fabs(v) > full) full = fabs(v);
                if (fabs(v - offset - gain * u) > worst) worst = fabs(v - offset - gain * u);
            } else {
                sums[0] += 1.0; sums[1] += u; sums[2] += v; sums[3] += u * u; sums[4] += u * v;
                through[side][0] += u * v;
                through[side][1] += u * u;
            }
        }
    }
    out[SERVOIDENT_ZERO_SHIFT] = id->values[2];
    out[SERVOIDENT_DEAD_SPACE] = id->values[1] + id->values[4] / id->values[3];
    out[SERVOIDENT_HYSTERESIS] = id->values[1];
    out[SERVOIDENT_KP] = id->values[3];
    out[SERVOIDENT_FRICTION] = id->values[4];
    out[SERVOIDENT_T] = id->values[0];
    out[SERVOIDENT_GAIN] = gain;
    out[SERVOIDENT_GAIN_FORWARD] = through[0][0] / through[0][1];
    out[SERVOIDENT_GAIN_BACK] = through[1][0] / through[1][1];
    out[SERVOIDENT_NONLINEARITY] = worst / full;
    mean = 0.5 * (out[SERVOIDENT_GAIN_FORWARD] + out[SERVOIDENT_GAIN_BACK]);
    out[SERVOIDENT_ASYMMETRY] = (out[SERVOIDENT_GAIN_FORWARD] - out[SERVOIDENT_GAIN_BACK]) / mean;
}

static inline int servoident_identify(servoident_identification *id, servoident_read read, void *context)
{
    double damping = 1e-4, rise = 2.0, step[SERVOIDENT_VALUES], next[SERVOIDENT_VALUES], promised = 0.0, error, kept;
    int ok = 0;
    if (!id->begun) memcpy(id->values, servoident_begin, sizeof id->values);
    id->error = servoident_sum(id, id->values, read, context);
    memcpy(id->normal, id->tried, sizeof id->normal);
    for (id->steps = 0; id->steps < 60; id->steps++) {
        promised = servoident_step_of(id, damping, step);
        if (!(promised > 1e-12 * id->error)) {
            ok = promised >= 0.0;
            break;
        }
        servoident_moved(id->values, step, next);
        error = servoident_sum(id, next, read, context);
        if (error < id->error) {
            kept = 1.0 - pow(2.0 * (id->error - error) / promised - 1.0, 3.0);
            damping *= kept > 0.1 ? kept : 0.1;
            if (damping < 1e-12) damping = 1e-12;
            rise = 2.0;
            id->error = error;
            memcpy(id->values, next, sizeof next);
            memcpy(id->normal, id->tried, sizeof id->normal);
        } else if (damping > 1e6 || promised < 1e-9 * id->error) {
            ok = promised < 1e-7 * id->error;
            break;
        } else {
            damping *= rise;
            rise *= 2.0;
        }
    }
    servoident_sheet(id);
    return ok;
}

#endif
""")

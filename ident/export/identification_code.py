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

$simulation
/* sums of weighted products about the mean */
typedef struct {
    double weight, mean[SERVOIDENT_ROWS], products[SERVOIDENT_ROWS][SERVOIDENT_ROWS];
} servoident_sums;

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

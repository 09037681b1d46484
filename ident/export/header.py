"""The nonlinear chain as one C header (C99 and C++), with no library beside the mathematical one."""

from __future__ import annotations

import re

from ident.chain.chain import INPUT
from ident.export.c_lines import c_lines, comment, number
from ident.export.machine import ExportedMachine


def as_header(machine: ExportedMachine) -> str:
    """The header: one call a sample takes the command that is held from there on, and gives every output channel.

    Its equations are the lines of the kernel that simulates the machine here; it takes the same steps.
    """
    packed, built = machine.kernel, machine.kernel.kernel
    shown = dict(zip(machine.outputs, (built.shown, *built.beside.values()), strict=True))
    before = built.inputs[INPUT]
    kept = {*shown.values(), *(row for row, _ in built.constants), before + 2}
    advance = c_lines(built.lines, set(range(len(packed.rows))) - kept)
    show = c_lines(built.lines, set(shown.values()))
    for place, row in enumerate(shown.values()):
        show = [re.sub(rf"^b\[{row}\] =", f"y[{place}] =", line) for line in show]
    return _HEADER.format(
        title=comment(f"{machine.preset.title}: {machine.driven_by} in, {', '.join(shown)} out"),
        conditions="\n".join(f" *   {comment(f'{name} = {value:.9g}')}" for name, value in machine.values.items()),
        channels="\n".join(f" *   y[{i}] {name} in {machine.unit(name)}" for i, name in enumerate(shown)),
        names="\n".join(f"#define SERVOIDENT_{name.upper()} {place}" for place, name in enumerate(shown)),
        outputs=len(shown),
        rows=len(packed.rows),
        rate=number(machine.sample_rate),
        steps=machine.steps,
        late=int(packed.whole[0]),
        delayed=int(packed.whole[0] + packed.share[0] > 0),
        before=before,
        start=",\n    ".join(number(value) for value in packed.rows[:, 0]),
        advance="\n    ".join(advance),
        show="\n    ".join(show),
    )


_HEADER = """/* {title}
 *
 * One call every 1/SERVOIDENT_SAMPLE_RATE s; the command u is held until the next one:
 *
 *     servoident_machine m;
 *     double y[SERVOIDENT_OUTPUTS];
 *     servoident_reset(&m);
 *     servoident_step(&m, u, y);     y is what is measured at the instant from which u acts
 *
{channels}
 *
 * At rest in the beginning; each sample is divided into SERVOIDENT_STEPS Runge-Kutta steps. In it, in SI units:
{conditions}
 */
#ifndef SERVOIDENT_MACHINE_H
#define SERVOIDENT_MACHINE_H

#include <math.h>
#include <string.h>

#define SERVOIDENT_SAMPLE_RATE {rate} /* Hz */
#define SERVOIDENT_STEPS {steps}
#define SERVOIDENT_LATE {late} /* whole steps by which the command acts later */
#define SERVOIDENT_ROWS {rows}
#define SERVOIDENT_OUTPUTS {outputs}
{names}

typedef struct {{
    double b[SERVOIDENT_ROWS];         /* constants, states and the command before, now and then */
    double late[SERVOIDENT_LATE + 1];  /* commands that have yet to act */
    double u;
    double steps;                      /* taken since the beginning */
    int begun;
    int place;
}} servoident_machine;

static const double servoident_start[SERVOIDENT_ROWS] = {{
    {start}
}};

static inline void servoident_reset(servoident_machine *m)
{{
    memset(m, 0, sizeof *m);
    memcpy(m->b, servoident_start, sizeof m->b);
}}

/* the command that acts where one of u is given: that of SERVOIDENT_LATE steps ago */
static inline double servoident_late(servoident_machine *m, double u)
{{
    m->late[m->place] = u;
    m->place = (m->place + 1) % (SERVOIDENT_LATE + 1);
    return m->late[m->place];
}}

static inline void servoident_advance(double *b, double k)
{{
    (void)k;
    {advance}
}}

static inline void servoident_show(const double *b, double k, double *y)
{{
    (void)k;
    {show}
}}

static inline void servoident_step(servoident_machine *m, double u, double *y)
{{
    int i;
    if (!m->begun) {{
        m->begun = 1;
        m->b[{before} + 1] = servoident_late(m, u);
        m->b[{before}] = {delayed} ? 0.0 : u;
    }} else {{
        for (i = 1; i <= SERVOIDENT_STEPS; i++) {{
            m->b[{before} + 2] = servoident_late(m, i < SERVOIDENT_STEPS ? m->u : u);
            servoident_advance(m->b, m->steps);
            m->steps += 1.0;
        }}
    }}
    m->u = u;
    servoident_show(m->b, m->steps, y);
}}

#endif
"""

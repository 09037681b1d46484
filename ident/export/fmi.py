"""The interface of a functional mock-up unit in C: FMI 2.0 for co-simulation, around the header of a machine.

Functional Mock-up Interface for Model Exchange and Co-Simulation, version 2.0.4, Modelica Association, 2022.
"""

FMI_C = r"""/* FMI 2.0 for co-simulation: value 0 is the command, values 1 to SERVOIDENT_OUTPUTS are the channels. */
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include "machine.h"

#if defined _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef struct {
    void (*logger)(void *, const char *, fmi2Status, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, fmi2Status);
    void *environment;
} fmi2CallbackFunctions;

typedef struct {
    servoident_machine machine;
    double u;
    double y[SERVOIDENT_OUTPUTS];
} state;

typedef struct {
    state now;
    const fmi2CallbackFunctions *calls;
    char name[64];
} instance;

static fmi2Status refused(instance *i, const char *why)
{
    if (i->calls && i->calls->logger)
        i->calls->logger(i->calls->environment, i->name, fmi2Error, "logStatusError", "%s", why);
    return fmi2Error;
}

/* what is measured now: the step to here is taken on a copy, for the next command may still differ */
static void show(state *s)
{
    servoident_machine ahead = s->machine;
    servoident_step(&ahead, s->u, s->y);
}

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                             const fmi2CallbackFunctions *calls, int visible, int logging)
{
    instance *i = calloc(1, sizeof *i);
    (void)resources; (void)visible; (void)logging;
    if (!i)
        return NULL;
    i->calls = calls;
    strncpy(i->name, name ? name : "", sizeof i->name - 1);
    if (type != 1 || !guid || strcmp(guid, SERVOIDENT_GUID)) {
        refused(i, "this unit is for co-simulation, and its description has to be its own");
        free(i);
        return NULL;
    }
    servoident_reset(&i->now.machine);
    show(&i->now);
    return i;
}

EXPORT void fmi2FreeInstance(void *c) { free(c); }
EXPORT fmi2Status fmi2SetDebugLogging(void *c, int on, size_t n, const char *const names[])
{ (void)c; (void)on; (void)n; (void)names; return fmi2OK; }
EXPORT fmi2Status fmi2SetupExperiment(void *c, int bounded, double tolerance, double start, int ends, double stop)
{ (void)c; (void)bounded; (void)tolerance; (void)start; (void)ends; (void)stop; return fmi2OK; }
EXPORT fmi2Status fmi2EnterInitializationMode(void *c) { (void)c; return fmi2OK; }
EXPORT fmi2Status fmi2ExitInitializationMode(void *c) { show(&((instance *)c)->now); return fmi2OK; }
EXPORT fmi2Status fmi2Terminate(void *c) { (void)c; return fmi2OK; }
EXPORT fmi2Status fmi2Reset(void *c)
{
    instance *i = c;
    memset(&i->now, 0, sizeof i->now);
    servoident_reset(&i->now.machine);
    show(&i->now);
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetReal(void *c, const unsigned references[], size_t n, double values[])
{
    instance *i = c;
    for (size_t k = 0; k < n; k++) {
        if (references[k] > SERVOIDENT_OUTPUTS)
            return refused(i, "there is no such value");
        values[k] = references[k] ? i->now.y[references[k] - 1] : i->now.u;
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetReal(void *c, const unsigned references[], size_t n, const double values[])
{
    instance *i = c;
    for (size_t k = 0; k < n; k++) {
        if (references[k])
            return refused(i, "only the command can be set");
        i->now.u = values[k];
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2DoStep(void *c, double at, double length, int final)
{
    instance *i = c;
    double samples = floor(length * SERVOIDENT_SAMPLE_RATE + 0.5);
    (void)at; (void)final;
    if (samples < 1.0 || fabs(length * SERVOIDENT_SAMPLE_RATE - samples) > 1e-6 * samples)
        return refused(i, "the communication step is not a whole number of samples");
    for (; samples > 0.0; samples -= 1.0)
        servoident_step(&i->now.machine, i->now.u, i->now.y);
    show(&i->now);
    for (int k = 0; k < SERVOIDENT_OUTPUTS; k++)
        if (!(i->now.y[k] - i->now.y[k] == 0.0))
            return refused(i, "the machine left the range of a computer");
    return fmi2OK;
}

EXPORT fmi2Status fmi2GetFMUstate(void *c, void **kept)
{
    if (!*kept)
        *kept = malloc(sizeof(state));
    if (!*kept)
        return refused(c, "no memory is left");
    memcpy(*kept, &((instance *)c)->now, sizeof(state));
    return fmi2OK;
}
EXPORT fmi2Status fmi2SetFMUstate(void *c, void *kept)
{ memcpy(&((instance *)c)->now, kept, sizeof(state)); return fmi2OK; }
EXPORT fmi2Status fmi2FreeFMUstate(void *c, void **kept)
{ (void)c; free(*kept); *kept = NULL; return fmi2OK; }

/* What this unit does not have: no value of another type, no derivatives, nothing that runs beside its caller. */
#define NOT_HERE(name, ...) \
    EXPORT fmi2Status name(void *c, __VA_ARGS__) { return refused(c, #name " is not provided"); }
#define NONE_OF(name, type) \
    EXPORT fmi2Status name(void *c, const unsigned r[], size_t n, type v[]) \
    { (void)r; (void)v; return n ? refused(c, #name ": there is no such value") : fmi2OK; }
NONE_OF(fmi2GetInteger, int)
NONE_OF(fmi2GetBoolean, int)
NONE_OF(fmi2GetString, const char *)
NONE_OF(fmi2SetInteger, const int)
NONE_OF(fmi2SetBoolean, const int)
NONE_OF(fmi2SetString, const char *const)
#if defined __GNUC__
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
NOT_HERE(fmi2SerializedFMUstateSize, void *s, size_t *n)
NOT_HERE(fmi2SerializeFMUstate, void *s, char b[], size_t n)
NOT_HERE(fmi2DeSerializeFMUstate, const char b[], size_t n, void **s)
NOT_HERE(fmi2GetDirectionalDerivative,
         const unsigned z[], size_t m, const unsigned v[], size_t n, const double a[], double b[])
NOT_HERE(fmi2SetRealInputDerivatives, const unsigned r[], size_t n, const int order[], const double v[])
NOT_HERE(fmi2GetRealOutputDerivatives, const unsigned r[], size_t n, const int order[], double v[])
NOT_HERE(fmi2GetStatus, int kind, fmi2Status *v)
NOT_HERE(fmi2GetRealStatus, int kind, double *v)
NOT_HERE(fmi2GetIntegerStatus, int kind, int *v)
NOT_HERE(fmi2GetBooleanStatus, int kind, int *v)
NOT_HERE(fmi2GetStringStatus, int kind, const char **v)
EXPORT fmi2Status fmi2CancelStep(void *c) { return refused(c, "a step cannot be cancelled"); }
"""
"""The source beside ``machine.h``; ``SERVOIDENT_GUID`` is given to the compiler or stands before it."""

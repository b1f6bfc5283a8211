/* The functions of FMI 3.0 around it: co-simulation by steps of one length. Types and signatures are those of the standard. What is
 * not supported says so and returns fmi3Error. */
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Longest step of the unit's own [s]; compile with another one where forces change faster. */
#ifndef LINKWEAR_STEP
#define LINKWEAR_STEP UNIT_STEP
#endif

#ifndef FMI3_FUNCTION_PREFIX
#define UNIT_NAME(name) name
#else
#define UNIT_JOINED(a, b) a##b
#define UNIT_JOIN(a, b) UNIT_JOINED(a, b)
#define UNIT_NAME(name) UNIT_JOIN(FMI3_FUNCTION_PREFIX, name)
#endif
#if defined(_WIN32) || defined(__CYGWIN__)
#define UNIT_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define UNIT_EXPORT __attribute__((visibility("default")))
#else
#define UNIT_EXPORT
#endif
#define UNIT_CALL(name) UNIT_EXPORT unit_status UNIT_NAME(name)

typedef enum { UNIT_OK, UNIT_WARNING, UNIT_DISCARD, UNIT_ERROR, UNIT_FATAL } unit_status;
typedef uint32_t unit_reference;
typedef void (*unit_log)(void *environment, unit_status status, const char *category, const char *message);

/* References count from 0: time, then so many of each kind. */
enum {
    UNIT_STATES = PFX_COORDINATES + PFX_SPEEDS,
    UNIT_OF_PARAMETERS = 1,
    UNIT_OF_OUTPUTS = UNIT_OF_PARAMETERS + PFX_PARAMETERS,
    UNIT_OF_STATES = UNIT_OF_OUTPUTS + UNIT_OUTPUTS,
    UNIT_OF_DERIVATIVES = UNIT_OF_STATES + UNIT_STATES,
    UNIT_OF_INDICATORS = UNIT_OF_DERIVATIVES + UNIT_STATES,
    UNIT_OF_CONSTANTS = UNIT_OF_INDICATORS + PFX_CONTACTS,
    UNIT_ALL = UNIT_OF_CONSTANTS + UNIT_CONSTANTS
};

typedef enum { UNIT_NEW, UNIT_INITIALIZATION, UNIT_EVENT, UNIT_STEP_MODE, UNIT_TERMINATED } unit_mode;

/* All of an instance that a step changes. */
typedef struct {
    unit_mode mode;
    int has_stop;
    /* whether the mechanism has begun to move, and whether values are those of its state */
    int has_begun, is_seen;
    double start, stop, t;
    double parameters[PFX_PARAMETERS + 1];
    double y[PFX_STATE];
    pfx_memory memory;
    double columns[UNIT_OUTPUTS + 1];
    double rates[UNIT_STATES + 1];
    double depths[PFX_CONTACTS + 1];
} unit_moment;

/* A moment that was kept, as it is written to bytes too. */
typedef struct {
    char token[40];
    uint64_t sum;
    unit_moment moment;
} unit_kept;

typedef struct {
    unit_moment now;
    int uses_events, is_verbose;
    unit_log log;
    void *environment;
} unit_instance;

static unit_status unit_fail(const unit_instance *unit, const char *form, ...)
{
    if (unit != NULL && unit->log != NULL) {
        char text[256];
        va_list values;
        va_start(values, form);
        vsnprintf(text, sizeof text, form, values);
        va_end(values);
        unit->log(unit->environment, UNIT_ERROR, "logStatusError", text);
    }
    return UNIT_ERROR;
}

static unit_status unit_unsupported(const void *instance, const char *name)
{
    return unit_fail(instance, "%s is not supported by the sources of this unit", name);
}

static int unit_is_in(const unit_instance *unit, unit_mode mode, const char *call)
{
    if (unit != NULL && unit->now.mode == mode) {
        return 1;
    }
    unit_fail(unit, "%s is not allowed now", call);
    return 0;
}

/* Columns of the present state; angles go on from where they were. */
static unit_status unit_see(unit_instance *unit, double before)
{
    unit_moment *const now = &unit->now;
    double old[UNIT_OUTPUTS + 1];
    const int goes_on = now->is_seen;
    int i;
    memcpy(old, now->columns, sizeof old);
    pfx_outputs(now->parameters, now->t, now->y, now->memory.contacts, now->columns, now->rates, now->depths);
    for (i = 0; i < UNIT_OUTPUTS; ++i) {
        if (!(fabs(now->columns[i]) < HUGE_VAL)) {
            return unit_fail(unit, "an output is infinite, or no number, at %.17g s", now->t);
        }
    }
    for (i = 0; goes_on && i + 1 < PFX_CHANNELS; ++i) {
        if (unit_wraps[i]) {
            const double turn = 2.0 * 3.141592653589793;
            const double near = old[i] + 0.5 * (now->t - before) * (old[i + 1] + now->columns[i + 1]);
            now->columns[i] = now->columns[i] + turn * round((near - now->columns[i]) / turn);
        }
    }
    now->is_seen = 1;
    return UNIT_OK;
}

static unit_status unit_stopped(const unit_instance *unit, int status)
{
    const char *const why = status == PFX_OTHER_START     ? "what was set, or the time, asks for another start, which sources cannot assemble: "
                                                            "set it by `linkwear fmu --set`, or use the unit's library; stopped"
                            : status == PFX_NEARLY_SINGULAR ? "the position is nearly singular"
                            : status == PFX_OPEN_LOOP     ? "the loops cannot be closed"
                                                          : "a number is infinite, or none";
    return unit_fail(unit, "%s at %.17g s", why, unit->now.t);
}

/* Begins where the file starts, with the parameters as they are. */
static unit_status unit_begin(unit_instance *unit)
{
    unit_moment *const now = &unit->now;
    int status;
    now->t = now->start;
    memset(now->y, 0, sizeof now->y);
    memset(&now->memory, 0, sizeof now->memory);
    now->is_seen = 0;
    status = pfx_take_start(now->parameters, now->t, now->y, &now->memory);
    if (status != PFX_DONE) {
        return unit_stopped(unit, status);
    }
    now->has_begun = 1;
    return unit_see(unit, now->t);
}

/* Values belong to the parameters as they are. */
static unit_status unit_ready(unit_instance *unit)
{
    if (unit->now.mode == UNIT_NEW) {
        return unit_fail(unit, "values are known from the initialization mode on");
    }
    if (!unit->now.has_begun) {
        return unit_begin(unit);
    }
    return unit->now.is_seen ? UNIT_OK : unit_see(unit, unit->now.t);
}

static void unit_reset(unit_instance *unit)
{
    int i;
    memset(&unit->now, 0, sizeof unit->now);
    for (i = 0; i < PFX_PARAMETERS; ++i) {
        unit->now.parameters[i] = unit_defaults[i];
    }
}

static uint64_t unit_sum(const unit_moment *moment)
{
    const unsigned char *const bytes = (const unsigned char *)moment;
    uint64_t sum = 14695981039346656037u;
    size_t i;
    for (i = 0; i < sizeof *moment; ++i) {
        sum = (sum ^ bytes[i]) * 1099511628211u;
    }
    return sum;
}

UNIT_EXPORT const char *UNIT_NAME(fmi3GetVersion)(void)
{
    return "3.0";
}

UNIT_CALL(fmi3SetDebugLogging)(void *instance, bool on, size_t count, const char *const *categories)
{
    unit_instance *const unit = instance;
    if (unit == NULL || (count > 0 && categories == NULL)) {
        return unit_fail(unit, "a pointer is null");
    }
    unit->is_verbose = on;
    return UNIT_OK;
}

UNIT_EXPORT void *UNIT_NAME(fmi3InstantiateCoSimulation)(const char *name, const char *token, const char *resources, bool visible,
                                                         bool verbose, bool events, bool early_return, const unit_reference *wanted,
                                                         size_t count, void *environment, unit_log log, void *update)
{
    unit_instance *unit;
    (void)name, (void)resources, (void)visible, (void)early_return, (void)wanted, (void)count, (void)update;
    if (token == NULL || strcmp(token, unit_token) != 0) {
        if (log != NULL) {
            log(environment, UNIT_ERROR, "logStatusError", "the instantiation token is that of another unit");
        }
        return NULL;
    }
    unit = malloc(sizeof *unit);
    if (unit != NULL) {
        memset(unit, 0, sizeof *unit);
        unit->uses_events = events;
        unit->is_verbose = verbose;
        unit->log = log;
        unit->environment = environment;
        unit_reset(unit);
    }
    return unit;
}

UNIT_EXPORT void *UNIT_NAME(fmi3InstantiateModelExchange)(const char *name, const char *token, const char *resources, bool visible,
                                                          bool verbose, void *environment, unit_log log)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)verbose;
    if (log != NULL) {
        log(environment, UNIT_ERROR, "logStatusError", "the sources of this unit have no model exchange; its binaries have");
    }
    return NULL;
}

UNIT_EXPORT void *UNIT_NAME(fmi3InstantiateScheduledExecution)(const char *name, const char *token, const char *resources,
                                                               bool visible, bool verbose, void *environment, unit_log log,
                                                               void *update, void *lock, void *unlock)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)verbose, (void)update, (void)lock, (void)unlock;
    if (log != NULL) {
        log(environment, UNIT_ERROR, "logStatusError", "there is no scheduled execution");
    }
    return NULL;
}

UNIT_EXPORT void UNIT_NAME(fmi3FreeInstance)(void *instance)
{
    free(instance);
}

UNIT_CALL(fmi3EnterInitializationMode)(void *instance, bool has_tolerance, double tolerance, double start, bool has_stop, double stop)
{
    unit_instance *const unit = instance;
    (void)has_tolerance, (void)tolerance;
    if (!unit_is_in(unit, UNIT_NEW, "fmi3EnterInitializationMode")) {
        return UNIT_ERROR;
    }
    if (!(fabs(start) < HUGE_VAL) || (has_stop && !(start < stop && stop < HUGE_VAL))) {
        return unit_fail(unit, "the start time must be finite and before the stop time");
    }
    unit->now.mode = UNIT_INITIALIZATION;
    unit->now.start = unit->now.t = start;
    unit->now.has_stop = has_stop;
    unit->now.stop = has_stop ? stop : 0.0;
    return UNIT_OK;
}

UNIT_CALL(fmi3ExitInitializationMode)(void *instance)
{
    unit_instance *const unit = instance;
    if (!unit_is_in(unit, UNIT_INITIALIZATION, "fmi3ExitInitializationMode") || unit_ready(unit) != UNIT_OK) {
        return UNIT_ERROR;
    }
    unit->now.mode = unit->uses_events ? UNIT_EVENT : UNIT_STEP_MODE;
    return UNIT_OK;
}

UNIT_CALL(fmi3EnterEventMode)(void *instance)
{
    unit_instance *const unit = instance;
    if (!unit_is_in(unit, UNIT_STEP_MODE, "fmi3EnterEventMode")) {
        return UNIT_ERROR;
    }
    if (!unit->uses_events) {
        return unit_fail(unit, "fmi3EnterEventMode needs an instance with eventModeUsed");
    }
    unit->now.mode = UNIT_EVENT;
    return UNIT_OK;
}

UNIT_CALL(fmi3EnterStepMode)(void *instance)
{
    unit_instance *const unit = instance;
    if (!unit_is_in(unit, UNIT_EVENT, "fmi3EnterStepMode")) {
        return UNIT_ERROR;
    }
    unit->now.mode = UNIT_STEP_MODE;
    return UNIT_OK;
}

UNIT_CALL(fmi3UpdateDiscreteStates)(void *instance, bool *again, bool *terminate, bool *nominals, bool *values, bool *has_next,
                                    double *next)
{
    unit_instance *const unit = instance;
    if (!unit_is_in(unit, UNIT_EVENT, "fmi3UpdateDiscreteStates")) {
        return UNIT_ERROR;
    }
    if (again == NULL || terminate == NULL || nominals == NULL || values == NULL || has_next == NULL || next == NULL) {
        return unit_fail(unit, "a pointer is null");
    }
    *again = *terminate = *nominals = *values = *has_next = false;
    *next = 0.0;
    return UNIT_OK;
}

UNIT_CALL(fmi3EvaluateDiscreteStates)(void *instance)
{
    return instance == NULL ? UNIT_ERROR : UNIT_OK;
}

UNIT_CALL(fmi3Terminate)(void *instance)
{
    unit_instance *const unit = instance;
    if (unit == NULL || (unit->now.mode != UNIT_EVENT && unit->now.mode != UNIT_STEP_MODE)) {
        return unit_fail(unit, "fmi3Terminate is not allowed now");
    }
    unit->now.mode = UNIT_TERMINATED;
    return UNIT_OK;
}

UNIT_CALL(fmi3Reset)(void *instance)
{
    if (instance == NULL) {
        return UNIT_ERROR;
    }
    unit_reset(instance);
    return UNIT_OK;
}

UNIT_CALL(fmi3GetFloat64)(void *instance, const unit_reference *references, size_t count, double *values, size_t value_count)
{
    unit_instance *const unit = instance;
    const unit_moment *now;
    size_t i;
    if (unit == NULL || count != value_count || (count > 0 && (references == NULL || values == NULL))) {
        return unit_fail(unit, "give as many values as references, and no null pointer");
    }
    now = &unit->now;
    for (i = 0; i < count; ++i) {
        const unit_reference of = references[i];
        if (of >= UNIT_ALL) {
            return unit_fail(unit, "there is no variable %lu", (unsigned long)of);
        }
        if (of >= UNIT_OF_OUTPUTS && of < UNIT_OF_CONSTANTS && unit_ready(unit) != UNIT_OK) {
            return UNIT_ERROR;
        }
        if (of < UNIT_OF_PARAMETERS) {
            values[i] = now->t;
        } else if (of < UNIT_OF_OUTPUTS) {
            values[i] = now->parameters[of - UNIT_OF_PARAMETERS];
        } else if (of < UNIT_OF_STATES) {
            values[i] = now->columns[of - UNIT_OF_OUTPUTS];
        } else if (of < UNIT_OF_DERIVATIVES) {
            values[i] = now->y[of - UNIT_OF_STATES];
        } else if (of < UNIT_OF_INDICATORS) {
            values[i] = now->rates[of - UNIT_OF_DERIVATIVES];
        } else if (of < UNIT_OF_CONSTANTS) {
            values[i] = now->depths[of - UNIT_OF_INDICATORS];
        } else {
            values[i] = unit_constants[of - UNIT_OF_CONSTANTS];
        }
    }
    return UNIT_OK;
}

UNIT_CALL(fmi3SetFloat64)(void *instance, const unit_reference *references, size_t count, const double *values, size_t value_count)
{
    unit_instance *const unit = instance;
    size_t i;
    int is_new;
    if (unit == NULL || count != value_count || (count > 0 && (references == NULL || values == NULL))) {
        return unit_fail(unit, "give as many values as references, and no null pointer");
    }
    is_new = unit->now.mode == UNIT_NEW || unit->now.mode == UNIT_INITIALIZATION;
    for (i = 0; i < count; ++i) {
        const unit_reference of = references[i];
        const int is_input = of >= UNIT_OF_OUTPUTS - PFX_INPUTS;
        if (of < UNIT_OF_PARAMETERS || of >= UNIT_OF_OUTPUTS) {
            return unit_fail(unit, "variable %lu is no parameter that can be set", (unsigned long)of);
        }
        if (!(fabs(values[i]) < HUGE_VAL)) {
            return unit_fail(unit, "a parameter must be finite");
        }
        if (!is_new && is_input && unit_is_fixed[of - UNIT_OF_PARAMETERS]) {
            return unit_fail(unit, "a drive follows input %lu: while it moves, the library that comes with the unit is needed", (unsigned long)of);
        }
        if (!is_new && (unit_is_fixed[of - UNIT_OF_PARAMETERS] || unit->now.mode == UNIT_TERMINATED
                        || (unit->uses_events && unit->now.mode != UNIT_EVENT && !is_input))) {
            return unit_fail(unit, "parameter %lu cannot be changed now", (unsigned long)of);
        }
    }
    for (i = 0; i < count; ++i) {
        unit->now.parameters[references[i] - UNIT_OF_PARAMETERS] = values[i];
    }
    if (is_new) {
        unit->now.has_begun = 0;
        return UNIT_OK;
    }
    return count > 0 ? unit_see(unit, unit->now.t) : UNIT_OK;
}

UNIT_CALL(fmi3DoStep)(void *instance, double from, double length, bool no_set_before, bool *event, bool *terminate, bool *early,
                      double *last)
{
    unit_instance *const unit = instance;
    unit_moment *now;
    double slack, begin, end, parts;
    (void)no_set_before;
    if (!unit_is_in(unit, UNIT_STEP_MODE, "fmi3DoStep")) {
        return UNIT_ERROR;
    }
    now = &unit->now;
    slack = 1e-9 * (fabs(now->t) < fabs(length) ? fabs(length) : fabs(now->t));
    if (!(fabs(from - now->t) <= slack)) {
        return unit_fail(unit, "the step begins at %.17g s, the unit is at %.17g s", from, now->t);
    }
    if (!(0.0 < length && length < HUGE_VAL)) {
        return unit_fail(unit, "a step of %.17g s leads nowhere", length);
    }
    end = from + length;
    if (now->has_stop && end > now->stop + slack) {
        return unit_fail(unit, "the step ends at %.17g s, after the stop time of %.17g s", end, now->stop);
    }
    end = now->has_stop && fabs(end - now->stop) <= slack ? now->stop : end;
    begin = now->t;
    parts = ceil((end - begin) / LINKWEAR_STEP * (1.0 - 1e-9));
    parts = parts < 1.0 ? 1.0 : parts;
    {
        double part;
        for (part = 1.0; part <= parts; part += 1.0) {
            const double before = now->t;
            const double next = part == parts ? end : begin + (end - begin) * (part / parts);
            const int status = pfx_rk4_step(now->parameters, before, next - before, now->y, &now->memory);
            if (status != PFX_DONE) {
                return unit_stopped(unit, status);
            }
            now->t = next;
            /* Turns of angles are counted from step to step. */
            if ((UNIT_WRAPS || part == parts) && unit_see(unit, before) != UNIT_OK) {
                return UNIT_ERROR;
            }
        }
    }
    if (event != NULL) {
        *event = false;
    }
    if (terminate != NULL) {
        *terminate = false;
    }
    if (early != NULL) {
        *early = false;
    }
    if (last != NULL) {
        *last = now->t;
    }
    return UNIT_OK;
}

UNIT_CALL(fmi3GetFMUState)(void *instance, void **state)
{
    unit_instance *const unit = instance;
    unit_kept *kept;
    if (unit == NULL || state == NULL) {
        return unit_fail(unit, "a pointer is null");
    }
    kept = *state == NULL ? malloc(sizeof *kept) : *state;
    if (kept == NULL) {
        return unit_fail(unit, "there is no memory left");
    }
    memset(kept, 0, sizeof *kept);
    memcpy(kept->token, unit_token, sizeof unit_token);
    memcpy(&kept->moment, &unit->now, sizeof kept->moment);
    kept->sum = unit_sum(&kept->moment);
    *state = kept;
    return UNIT_OK;
}

UNIT_CALL(fmi3SetFMUState)(void *instance, void *state)
{
    unit_instance *const unit = instance;
    const unit_kept *const kept = state;
    if (unit == NULL || kept == NULL) {
        return unit_fail(unit, "there is no such state");
    }
    memcpy(&unit->now, &kept->moment, sizeof unit->now);
    return UNIT_OK;
}

UNIT_CALL(fmi3FreeFMUState)(void *instance, void **state)
{
    if (instance == NULL) {
        return UNIT_ERROR;
    }
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return UNIT_OK;
}

UNIT_CALL(fmi3SerializedFMUStateSize)(void *instance, void *state, size_t *size)
{
    if (instance == NULL || state == NULL || size == NULL) {
        return unit_fail(instance, "a pointer is null");
    }
    *size = sizeof(unit_kept);
    return UNIT_OK;
}

UNIT_CALL(fmi3SerializeFMUState)(void *instance, void *state, uint8_t *bytes, size_t size)
{
    if (instance == NULL || state == NULL || bytes == NULL || size < sizeof(unit_kept)) {
        return unit_fail(instance, "there is too little room for the state, or a pointer is null");
    }
    memcpy(bytes, state, sizeof(unit_kept));
    return UNIT_OK;
}

UNIT_CALL(fmi3DeserializeFMUState)(void *instance, const uint8_t *bytes, size_t size, void **state)
{
    unit_kept *kept;
    if (instance == NULL || bytes == NULL || state == NULL || size != sizeof *kept) {
        return unit_fail(instance, "these bytes are no state of this unit");
    }
    kept = malloc(sizeof *kept);
    if (kept == NULL) {
        return unit_fail(instance, "there is no memory left");
    }
    memcpy(kept, bytes, sizeof *kept);
    if (memcmp(kept->token, unit_token, sizeof unit_token) != 0 || kept->sum != unit_sum(&kept->moment)) {
        free(kept);
        return unit_fail(instance, "these bytes are no state of this unit, or damaged");
    }
    *state = kept;
    return UNIT_OK;
}

/* Values of types that no variable has: asking for none is no mistake. */
static unit_status unit_none(const void *instance, size_t count, const char *name)
{
    if (instance != NULL && count == 0) {
        return UNIT_OK;
    }
    return unit_fail(instance, "%s: no variable of this unit has this type", name);
}

#define UNIT_TYPE(get, set, type)                                                                                                   \
    UNIT_CALL(get)(void *instance, const unit_reference *references, size_t count, type *values, size_t value_count)                \
    {                                                                                                                               \
        (void)references, (void)values, (void)value_count;                                                                          \
        return unit_none(instance, count, #get);                                                                                    \
    }                                                                                                                               \
    UNIT_CALL(set)(void *instance, const unit_reference *references, size_t count, const type *values, size_t value_count)          \
    {                                                                                                                               \
        (void)references, (void)values, (void)value_count;                                                                          \
        return unit_none(instance, count, #set);                                                                                    \
    }
typedef const char *unit_text;
UNIT_TYPE(fmi3GetFloat32, fmi3SetFloat32, float)
UNIT_TYPE(fmi3GetInt8, fmi3SetInt8, int8_t)
UNIT_TYPE(fmi3GetUInt8, fmi3SetUInt8, uint8_t)
UNIT_TYPE(fmi3GetInt16, fmi3SetInt16, int16_t)
UNIT_TYPE(fmi3GetUInt16, fmi3SetUInt16, uint16_t)
UNIT_TYPE(fmi3GetInt32, fmi3SetInt32, int32_t)
UNIT_TYPE(fmi3GetUInt32, fmi3SetUInt32, uint32_t)
UNIT_TYPE(fmi3GetInt64, fmi3SetInt64, int64_t)
UNIT_TYPE(fmi3GetUInt64, fmi3SetUInt64, uint64_t)
UNIT_TYPE(fmi3GetBoolean, fmi3SetBoolean, bool)
UNIT_TYPE(fmi3GetString, fmi3SetString, unit_text)

UNIT_CALL(fmi3GetBinary)(void *instance, const unit_reference *references, size_t count, size_t *sizes, const uint8_t **values,
                         size_t value_count)
{
    (void)references, (void)sizes, (void)values, (void)value_count;
    return unit_none(instance, count, "fmi3GetBinary");
}

UNIT_CALL(fmi3SetBinary)(void *instance, const unit_reference *references, size_t count, const size_t *sizes,
                         const uint8_t *const *values, size_t value_count)
{
    (void)references, (void)sizes, (void)values, (void)value_count;
    return unit_none(instance, count, "fmi3SetBinary");
}

UNIT_CALL(fmi3GetClock)(void *instance, const unit_reference *references, size_t count, bool *values)
{
    (void)references, (void)values;
    return unit_none(instance, count, "fmi3GetClock");
}

UNIT_CALL(fmi3SetClock)(void *instance, const unit_reference *references, size_t count, const bool *values)
{
    (void)references, (void)values;
    return unit_none(instance, count, "fmi3SetClock");
}

/* What is not supported: arguments as the standard has them, none of them read. */
#define UNIT_UNSUPPORTED(name, ...)                                                                                                 \
    UNIT_CALL(name)(void *instance, __VA_ARGS__)                                                                                    \
    {                                                                                                                               \
        return unit_unsupported(instance, #name);                                                                                   \
    }
#define UNIT_UNSUPPORTED_ALONE(name)                                                                                                \
    UNIT_CALL(name)(void *instance)                                                                                                 \
    {                                                                                                                               \
        return unit_unsupported(instance, #name);                                                                                   \
    }
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
UNIT_UNSUPPORTED_ALONE(fmi3EnterConfigurationMode)
UNIT_UNSUPPORTED_ALONE(fmi3ExitConfigurationMode)
UNIT_UNSUPPORTED_ALONE(fmi3EnterContinuousTimeMode)
UNIT_UNSUPPORTED(fmi3GetNumberOfVariableDependencies, unit_reference variable, size_t *count)
UNIT_UNSUPPORTED(fmi3GetVariableDependencies, unit_reference dependent, size_t *elements, unit_reference *independents, size_t *others,
                 int *kinds, size_t count)
UNIT_UNSUPPORTED(fmi3GetDirectionalDerivative, const unit_reference *unknowns, size_t unknown_count, const unit_reference *knowns,
                 size_t known_count, const double *seed, size_t seed_count, double *sensitivity, size_t sensitivity_count)
UNIT_UNSUPPORTED(fmi3GetAdjointDerivative, const unit_reference *unknowns, size_t unknown_count, const unit_reference *knowns,
                 size_t known_count, const double *seed, size_t seed_count, double *sensitivity, size_t sensitivity_count)
UNIT_UNSUPPORTED(fmi3GetIntervalDecimal, const unit_reference *references, size_t count, double *intervals, int *qualifiers)
UNIT_UNSUPPORTED(fmi3GetIntervalFraction, const unit_reference *references, size_t count, uint64_t *counters, uint64_t *resolutions,
                 int *qualifiers)
UNIT_UNSUPPORTED(fmi3GetShiftDecimal, const unit_reference *references, size_t count, double *shifts)
UNIT_UNSUPPORTED(fmi3GetShiftFraction, const unit_reference *references, size_t count, uint64_t *counters, uint64_t *resolutions)
UNIT_UNSUPPORTED(fmi3SetIntervalDecimal, const unit_reference *references, size_t count, const double *intervals)
UNIT_UNSUPPORTED(fmi3SetIntervalFraction, const unit_reference *references, size_t count, const uint64_t *counters,
                 const uint64_t *resolutions)
UNIT_UNSUPPORTED(fmi3SetShiftDecimal, const unit_reference *references, size_t count, const double *shifts)
UNIT_UNSUPPORTED(fmi3SetShiftFraction, const unit_reference *references, size_t count, const uint64_t *counters,
                 const uint64_t *resolutions)
UNIT_UNSUPPORTED(fmi3CompletedIntegratorStep, bool no_set_before, bool *enter_event_mode, bool *terminate)
UNIT_UNSUPPORTED(fmi3SetTime, double t)
UNIT_UNSUPPORTED(fmi3SetContinuousStates, const double *states, size_t count)
UNIT_UNSUPPORTED(fmi3GetContinuousStates, double *states, size_t count)
UNIT_UNSUPPORTED(fmi3GetContinuousStateDerivatives, double *derivatives, size_t count)
UNIT_UNSUPPORTED(fmi3GetNominalsOfContinuousStates, double *nominals, size_t count)
UNIT_UNSUPPORTED(fmi3GetEventIndicators, double *indicators, size_t count)
UNIT_UNSUPPORTED(fmi3GetNumberOfEventIndicators, size_t *count)
UNIT_UNSUPPORTED(fmi3GetNumberOfContinuousStates, size_t *count)
UNIT_UNSUPPORTED(fmi3GetOutputDerivatives, const unit_reference *references, size_t count, const int32_t *orders, double *values,
                 size_t value_count)
UNIT_UNSUPPORTED(fmi3ActivateModelPartition, unit_reference clock, double t)

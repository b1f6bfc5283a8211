/* Drives a unit of FMI 3.0 as a tool would: types and signatures are those of the standard, written here by hand.
   driver LIBRARY RESOURCES TOKEN MODE ...   prints what it gets as hexadecimal numbers, one row a line. */
#include <dlfcn.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef int Status;
enum { OK, WARNING, DISCARD, ERROR, FATAL };
typedef void *Instance;
typedef uint32_t Ref;
typedef void (*Log)(void *, Status, const char *, const char *);

static int messages;
static void hear(void *environment, Status status, const char *category, const char *message) {
    (void)environment;
    messages++;
    if (getenv("DRIVER_VERBOSE")) fprintf(stderr, "[%d %s] %s\n", status, category, message);
}

static void *library;
static void *symbol(const char *name) {
    void *found = dlsym(library, name);
    if (!found) { fprintf(stderr, "no symbol %s\n", name); exit(3); }
    return found;
}
#define NEED(call, wanted) do { Status got = (call); if (got != (wanted)) { \
    fprintf(stderr, "line %d: %s gave %d\n", __LINE__, #call, got); exit(4); } } while (0)
#define FUNCTION(type, name, ...) type (*name)(__VA_ARGS__) = (type (*)(__VA_ARGS__))symbol(#name)

/* Zeroed room that lasts as long as the program: whoever looks for leaks finds those of the unit. */
static void *taken[64];
static size_t takes;
static void *take(size_t count, size_t size) {
    return taken[takes++] = calloc(count, size);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static void print_row(double t, const double *values, size_t count) {
    printf("%a", t);
    for (size_t i = 0; i < count; i++) printf(" %a", values[i]);
    printf("\n");
}

static const char *const ALL[] = {
    "fmi3GetVersion", "fmi3SetDebugLogging", "fmi3InstantiateModelExchange", "fmi3InstantiateCoSimulation",
    "fmi3InstantiateScheduledExecution", "fmi3FreeInstance", "fmi3EnterInitializationMode", "fmi3ExitInitializationMode",
    "fmi3EnterEventMode", "fmi3Terminate", "fmi3Reset", "fmi3GetFloat32", "fmi3GetFloat64", "fmi3GetInt8", "fmi3GetUInt8",
    "fmi3GetInt16", "fmi3GetUInt16", "fmi3GetInt32", "fmi3GetUInt32", "fmi3GetInt64", "fmi3GetUInt64", "fmi3GetBoolean",
    "fmi3GetString", "fmi3GetBinary", "fmi3GetClock", "fmi3SetFloat32", "fmi3SetFloat64", "fmi3SetInt8", "fmi3SetUInt8",
    "fmi3SetInt16", "fmi3SetUInt16", "fmi3SetInt32", "fmi3SetUInt32", "fmi3SetInt64", "fmi3SetUInt64", "fmi3SetBoolean",
    "fmi3SetString", "fmi3SetBinary", "fmi3SetClock", "fmi3GetNumberOfVariableDependencies", "fmi3GetVariableDependencies",
    "fmi3GetFMUState", "fmi3SetFMUState", "fmi3FreeFMUState", "fmi3SerializedFMUStateSize", "fmi3SerializeFMUState",
    "fmi3DeserializeFMUState", "fmi3GetDirectionalDerivative", "fmi3GetAdjointDerivative", "fmi3EnterConfigurationMode",
    "fmi3ExitConfigurationMode", "fmi3GetIntervalDecimal", "fmi3GetIntervalFraction", "fmi3GetShiftDecimal",
    "fmi3GetShiftFraction", "fmi3SetIntervalDecimal", "fmi3SetIntervalFraction", "fmi3SetShiftDecimal", "fmi3SetShiftFraction",
    "fmi3EvaluateDiscreteStates", "fmi3UpdateDiscreteStates", "fmi3EnterContinuousTimeMode", "fmi3CompletedIntegratorStep",
    "fmi3SetTime", "fmi3SetContinuousStates", "fmi3GetContinuousStateDerivatives", "fmi3GetEventIndicators",
    "fmi3GetContinuousStates", "fmi3GetNominalsOfContinuousStates", "fmi3GetNumberOfEventIndicators",
    "fmi3GetNumberOfContinuousStates", "fmi3EnterStepMode", "fmi3GetOutputDerivatives", "fmi3DoStep",
    "fmi3ActivateModelPartition",
};

int main(int argc, char **argv) {
    if (argc < 9) return 2;
    const char *resources = argv[2], *token = argv[3], *mode = argv[4];
    double stop = strtod(argv[5], NULL), tolerance = strtod(argv[6], NULL);
    size_t rows = strtoul(argv[7], NULL, 10);
    /* First reference and number of outputs. */
    Ref first = (Ref)strtoul(argv[8], NULL, 10);
    size_t count = argc > 9 ? strtoul(argv[9], NULL, 10) : 0;
    library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) { fprintf(stderr, "%s\n", dlerror()); return 3; }
    for (size_t i = 0; i < sizeof ALL / sizeof *ALL; i++) symbol(ALL[i]);
    if (sizeof ALL / sizeof *ALL != 75) return 5;

    FUNCTION(const char *, fmi3GetVersion, void);
    FUNCTION(Instance, fmi3InstantiateCoSimulation, const char *, const char *, const char *, bool, bool, bool, bool, const Ref *,
             size_t, void *, Log, void *);
    FUNCTION(Instance, fmi3InstantiateModelExchange, const char *, const char *, const char *, bool, bool, void *, Log);
    FUNCTION(void, fmi3FreeInstance, Instance);
    FUNCTION(Status, fmi3EnterInitializationMode, Instance, bool, double, double, bool, double);
    FUNCTION(Status, fmi3ExitInitializationMode, Instance);
    FUNCTION(Status, fmi3Terminate, Instance);
    FUNCTION(Status, fmi3Reset, Instance);
    FUNCTION(Status, fmi3GetFloat64, Instance, const Ref *, size_t, double *, size_t);
    FUNCTION(Status, fmi3SetFloat64, Instance, const Ref *, size_t, const double *, size_t);
    FUNCTION(Status, fmi3DoStep, Instance, double, double, bool, bool *, bool *, bool *, double *);
    FUNCTION(Status, fmi3GetFMUState, Instance, void **);
    FUNCTION(Status, fmi3SetFMUState, Instance, void *);
    FUNCTION(Status, fmi3FreeFMUState, Instance, void **);
    FUNCTION(Status, fmi3SerializedFMUStateSize, Instance, void *, size_t *);
    FUNCTION(Status, fmi3SerializeFMUState, Instance, void *, uint8_t *, size_t);
    FUNCTION(Status, fmi3DeserializeFMUState, Instance, const uint8_t *, size_t, void **);
    FUNCTION(Status, fmi3GetDirectionalDerivative, Instance, const Ref *, size_t, const Ref *, size_t, const double *, size_t,
             double *, size_t);
    FUNCTION(Status, fmi3GetAdjointDerivative, Instance, const Ref *, size_t, const Ref *, size_t, const double *, size_t,
             double *, size_t);
    FUNCTION(Status, fmi3EnterContinuousTimeMode, Instance);
    FUNCTION(Status, fmi3EnterEventMode, Instance);
    FUNCTION(Status, fmi3UpdateDiscreteStates, Instance, bool *, bool *, bool *, bool *, bool *, double *);
    FUNCTION(Status, fmi3CompletedIntegratorStep, Instance, bool, bool *, bool *);
    FUNCTION(Status, fmi3SetTime, Instance, double);
    FUNCTION(Status, fmi3SetContinuousStates, Instance, const double *, size_t);
    FUNCTION(Status, fmi3GetContinuousStates, Instance, double *, size_t);
    FUNCTION(Status, fmi3GetContinuousStateDerivatives, Instance, double *, size_t);
    FUNCTION(Status, fmi3GetNominalsOfContinuousStates, Instance, double *, size_t);
    FUNCTION(Status, fmi3GetNumberOfContinuousStates, Instance, size_t *);
    FUNCTION(Status, fmi3GetNumberOfEventIndicators, Instance, size_t *);
    FUNCTION(Status, fmi3GetEventIndicators, Instance, double *, size_t);
    FUNCTION(Status, fmi3GetString, Instance, const Ref *, size_t, const char **, size_t);
    FUNCTION(Status, fmi3EnterConfigurationMode, Instance);
    FUNCTION(Status, fmi3GetOutputDerivatives, Instance, const Ref *, size_t, const int32_t *, double *, size_t);

    if (strcmp(fmi3GetVersion(), "3.0")) return 6;
    Ref *refs = take(count + 1, sizeof *refs);
    double *values = take(count + 1, sizeof *values);
    for (size_t i = 0; i < count; i++) refs[i] = first + (Ref)i;
    bool no = false, *flag = &no;
    double last;
    /* An input that a drive follows, with its rates: it is told where it is, before every step or at every time of the integrator. */
    const char *leading = getenv("DRIVER_LEADS");
    Ref lead = leading ? (Ref)strtoul(leading, NULL, 10) : 0, course[3] = {lead, lead + 1, lead + 2};
    #define LEAD(t) do { if (leading) { double at = (t), w = 4.0 * 3.141592653589793; \
        double told[3] = {w * at + 0.1 * sin(3.0 * at), w + 0.3 * cos(3.0 * at), -0.9 * sin(3.0 * at)}; \
        NEED(fmi3SetFloat64(unit, course, 3, told, 3), OK); } } while (0)

    if (!strcmp(mode, "cs") || !strcmp(mode, "time")) {
        bool quiet = !strcmp(mode, "time");
        Instance unit = fmi3InstantiateCoSimulation("u", token, resources, false, false, false, false, NULL, 0, NULL, hear, NULL);
        if (!unit) return 7;
        NEED(fmi3EnterInitializationMode(unit, true, tolerance, 0.0, true, stop), OK);
        LEAD(0.0);
        NEED(fmi3ExitInitializationMode(unit), OK);
        double inside = 0.0;
        for (size_t i = 0; i < rows; i++) {
            double t = i + 1 == rows ? stop : stop * ((double)i / (double)(rows - 1));
            double begin = now();
            if (i > 0) {
                double before = stop * ((double)(i - 1) / (double)(rows - 1));
                LEAD(before);
                NEED(fmi3DoStep(unit, before, t - before, true, flag, flag, flag, &last), OK);
            }
            NEED(fmi3GetFloat64(unit, refs, count, values, count), OK);
            inside += now() - begin;
            if (!quiet) print_row(t, values, count);
        }
        if (quiet) printf("%.6f\n", 1e3 * inside);
        NEED(fmi3Terminate(unit), OK);
        fmi3FreeInstance(unit);
        return messages;
    }
    if (!strcmp(mode, "states")) {
        /* The same rows from a kept state, from a state out of bytes, and in another instance. */
        Instance unit = fmi3InstantiateCoSimulation("u", token, resources, false, false, false, false, NULL, 0, NULL, hear, NULL);
        NEED(fmi3EnterInitializationMode(unit, true, tolerance, 0.0, true, stop), OK);
        LEAD(0.0);
        NEED(fmi3ExitInitializationMode(unit), OK);
        LEAD(0.0);
        NEED(fmi3DoStep(unit, 0.0, 0.43 * stop, true, flag, flag, flag, &last), OK);
        void *state = NULL, *other = NULL;
        NEED(fmi3GetFMUState(unit, &state), OK);
        size_t size;
        NEED(fmi3SerializedFMUStateSize(unit, state, &size), OK);
        uint8_t *bytes = take(size, 1);
        NEED(fmi3SerializeFMUState(unit, state, bytes, size), OK);
        NEED(fmi3SerializeFMUState(unit, state, bytes, size - 1), ERROR);
        for (int round = 0; round < 3; round++) {
            if (round == 1) NEED(fmi3SetFMUState(unit, state), OK);
            if (round == 2) {
                NEED(fmi3FreeFMUState(unit, &state), OK);
                if (state) return 8;
                fmi3FreeInstance(unit);
                unit = fmi3InstantiateCoSimulation("v", token, resources, false, false, false, false, NULL, 0, NULL, hear, NULL);
                NEED(fmi3DeserializeFMUState(unit, bytes, size, &other), OK);
                NEED(fmi3SetFMUState(unit, other), OK);
                NEED(fmi3FreeFMUState(unit, &other), OK);
                if (other) return 8;
            }
            double t = 0.43 * stop;
            for (size_t i = 0; i < rows; i++, t += 0.01 * stop) {
                LEAD(t);
                NEED(fmi3DoStep(unit, t, 0.01 * stop, true, flag, flag, flag, &last), OK);
                NEED(fmi3GetFloat64(unit, refs, count, values, count), OK);
                print_row(last, values, count);
            }
        }
        bytes[size / 2] ^= 1;
        NEED(fmi3DeserializeFMUState(unit, bytes, size, &other), ERROR);
        fmi3FreeInstance(unit);
    } else if (!strcmp(mode, "me")) {
        /* The classical method of Runge and Kutta of this driver's own, with events where the unit wants them. */
        Instance unit = fmi3InstantiateModelExchange("u", token, resources, false, false, NULL, hear);
        if (!unit) return 7;
        NEED(fmi3EnterInitializationMode(unit, true, tolerance, 0.0, true, stop), OK);
        LEAD(0.0);
        NEED(fmi3ExitInitializationMode(unit), OK);
        NEED(fmi3UpdateDiscreteStates(unit, flag, flag, flag, flag, flag, &last), OK);
        NEED(fmi3EnterContinuousTimeMode(unit), OK);
        size_t n, nz;
        NEED(fmi3GetNumberOfContinuousStates(unit, &n), OK);
        NEED(fmi3GetNumberOfEventIndicators(unit, &nz), OK);
        double *x = take(n, sizeof *x), *y = take(n, sizeof *y), *k = take(4 * n, sizeof *k), *z = take(nz + 1, sizeof *z);
        NEED(fmi3GetNominalsOfContinuousStates(unit, y, n), OK);
        for (size_t i = 0; i < n; i++) if (!(y[i] > 0)) return 9;
        size_t steps = strtoul(argv[10], NULL, 10);
        double part[4] = {0.0, 0.5, 0.5, 1.0};
        for (size_t i = 0; i < rows; i++) {
            if (i > 0) {
                double from = stop * ((double)(i - 1) / (double)(rows - 1)), to = stop * ((double)i / (double)(rows - 1));
                for (size_t s = 0; s < steps; s++) {
                    double t = from + (to - from) * ((double)s / (double)steps), h = (to - from) / (double)steps;
                    NEED(fmi3GetContinuousStates(unit, x, n), OK);
                    for (int stage = 0; stage < 4; stage++) {
                        for (size_t j = 0; j < n; j++) y[j] = x[j] + (stage ? part[stage] * h * k[(stage - 1) * n + j] : 0.0);
                        NEED(fmi3SetTime(unit, t + part[stage] * h), OK);
                        NEED(fmi3SetContinuousStates(unit, y, n), OK);
                        LEAD(t + part[stage] * h);
                        NEED(fmi3GetContinuousStateDerivatives(unit, k + stage * n, n), OK);
                    }
                    for (size_t j = 0; j < n; j++)
                        y[j] = x[j] + h / 6.0 * (k[j] + 2.0 * k[n + j] + 2.0 * k[2 * n + j] + k[3 * n + j]);
                    NEED(fmi3SetTime(unit, s + 1 == steps ? to : t + h), OK);
                    NEED(fmi3SetContinuousStates(unit, y, n), OK);
                    LEAD(s + 1 == steps ? to : t + h);
                    NEED(fmi3GetEventIndicators(unit, z, nz), OK);
                    bool enter = false, end = false;
                    NEED(fmi3CompletedIntegratorStep(unit, true, &enter, &end), OK);
                    if (enter) {
                        NEED(fmi3EnterEventMode(unit), OK);
                        NEED(fmi3UpdateDiscreteStates(unit, flag, flag, flag, flag, flag, &last), OK);
                        NEED(fmi3EnterContinuousTimeMode(unit), OK);
                    }
                }
            }
            double t = stop * ((double)i / (double)(rows - 1));
            NEED(fmi3GetFloat64(unit, refs, count, values, count), OK);
            print_row(t, values, count);
        }
        fmi3FreeInstance(unit);
    } else if (!strcmp(mode, "derivatives")) {
        /* Largest difference between derivatives along each state and central differences, relative to the largest of its row. */
        Instance unit = fmi3InstantiateModelExchange("u", token, resources, false, false, NULL, hear);
        NEED(fmi3EnterInitializationMode(unit, true, tolerance, 0.0, true, stop), OK);
        LEAD(0.0);
        NEED(fmi3ExitInitializationMode(unit), OK);
        NEED(fmi3UpdateDiscreteStates(unit, flag, flag, flag, flag, flag, &last), OK);
        NEED(fmi3EnterContinuousTimeMode(unit), OK);
        size_t n;
        NEED(fmi3GetNumberOfContinuousStates(unit, &n), OK);
        double *x = take(n, sizeof *x), *low = take(n, sizeof *x), *high = take(n, sizeof *x), *found = take(n * n, sizeof *x);
        double *dual = take(n, sizeof *x), *size = take(n, sizeof *x), *nominal = take(n, sizeof *x), worst = 0.0, one = 1.0;
        NEED(fmi3GetContinuousStates(unit, x, n), OK);
        NEED(fmi3GetNominalsOfContinuousStates(unit, nominal, n), OK);
        Ref state = first + (Ref)count, *rates = take(n, sizeof *rates);
        for (size_t i = 0; i < n; i++) rates[i] = state + (Ref)(n + i);
        for (size_t j = 0; j < n; j++) {
            double kept = x[j], h = 1e-6 * nominal[j];
            x[j] = kept - h; fmi3SetContinuousStates(unit, x, n); fmi3GetContinuousStateDerivatives(unit, low, n);
            x[j] = kept + h; fmi3SetContinuousStates(unit, x, n); fmi3GetContinuousStateDerivatives(unit, high, n);
            x[j] = kept; fmi3SetContinuousStates(unit, x, n);
            Ref known = state + (Ref)j;
            NEED(fmi3GetDirectionalDerivative(unit, rates, n, &known, 1, &one, 1, dual, n), OK);
            for (size_t i = 0; i < n; i++) {
                double difference = (high[i] - low[i]) / (2.0 * h);
                found[i * n + j] = fabs(difference - dual[i]) * nominal[j];
                size[i] = fmax(size[i], fabs(dual[i]) * nominal[j]);
            }
        }
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++) worst = fmax(worst, found[i * n + j] / fmax(size[i], 1.0));
        printf("%.3e\n", worst);
        /* The adjoint is the transpose. */
        double *seed = take(n, sizeof *seed), *adjoint = take(n, sizeof *adjoint), forth = 0.0, back = 0.0;
        Ref *states = take(n, sizeof *states);
        for (size_t i = 0; i < n; i++) { states[i] = state + (Ref)i; seed[i] = 1.0 + (double)i; }
        NEED(fmi3GetAdjointDerivative(unit, rates, n, states, n, seed, n, adjoint, n), OK);
        NEED(fmi3GetDirectionalDerivative(unit, rates, n, states, n, seed, n, dual, n), OK);
        for (size_t i = 0; i < n; i++) { forth += seed[i] * dual[i]; back += seed[i] * adjoint[i]; }
        printf("%.3e\n", fabs(forth - back) / fmax(fabs(forth), 1.0));
        fmi3FreeInstance(unit);
    } else if (!strcmp(mode, "sources")) {
        /* A library out of the unit's sources: co-simulation alone. */
        if (fmi3InstantiateModelExchange("u", token, resources, false, false, NULL, hear)) return 20;
        if (fmi3InstantiateCoSimulation("u", "{no}", resources, 0, 0, 0, 0, NULL, 0, NULL, hear, NULL)) return 21;
        if (fmi3InstantiateCoSimulation("u", NULL, resources, 0, 0, 0, 0, NULL, 0, NULL, NULL, NULL)) return 22;
        Instance unit = fmi3InstantiateCoSimulation("u", token, NULL, false, true, false, false, NULL, 0, NULL, hear, NULL);
        Ref known = first, none = 1000000, time = 0;
        double value = 1.0;
        const char *text;
        NEED(fmi3DoStep(NULL, 0, 1e-3, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3DoStep(unit, 0, 1e-3, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3GetFloat64(unit, &known, 1, &value, 1), ERROR);
        NEED(fmi3EnterInitializationMode(unit, true, tolerance, 1.0, true, 0.5), ERROR);
        NEED(fmi3EnterInitializationMode(unit, true, tolerance, 0.0, true, stop), OK);
        NEED(fmi3GetFloat64(unit, &known, 1, &value, 1), OK);
        NEED(fmi3ExitInitializationMode(unit), OK);
        NEED(fmi3GetFloat64(unit, &none, 1, &value, 1), ERROR);
        NEED(fmi3GetFloat64(unit, NULL, 1, &value, 1), ERROR);
        NEED(fmi3GetFloat64(unit, &known, 1, &value, 2), ERROR);
        NEED(fmi3SetFloat64(unit, &known, 1, &value, 1), ERROR);
        NEED(fmi3GetString(unit, &known, 1, &text, 1), ERROR);
        NEED(fmi3GetString(unit, NULL, 0, NULL, 0), OK);
        NEED(fmi3GetDirectionalDerivative(unit, NULL, 0, NULL, 0, NULL, 0, NULL, 0), ERROR);
        NEED(fmi3EnterConfigurationMode(unit), ERROR);
        NEED(fmi3DoStep(unit, 0.1, 1e-3, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3DoStep(unit, 0.0, NAN, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3DoStep(unit, 0.0, 2 * stop, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3DoStep(unit, 0.0, 0.5 * stop, true, NULL, NULL, NULL, NULL), OK);
        NEED(fmi3GetFloat64(unit, &time, 1, &value, 1), OK);
        if (value != 0.5 * stop) return 23;
        NEED(fmi3SetFMUState(unit, NULL), ERROR);
        NEED(fmi3FreeFMUState(unit, NULL), OK);
        NEED(fmi3Terminate(unit), OK);
        NEED(fmi3DoStep(unit, 0.5 * stop, 1e-3, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3Reset(unit), OK);
        fmi3FreeInstance(unit);
        fmi3FreeInstance(NULL);
        printf("%d\n", messages);
    } else if (!strcmp(mode, "refused")) {
        /* A clearance that none can be, and a drive that would jump, stay refused until they are put right. */
        FUNCTION(Status, fmi3EnterStepMode, Instance);
        Ref clearance = (Ref)strtoul(argv[10], NULL, 10), other = argc > 11 ? (Ref)strtoul(argv[11], NULL, 10) : 0;
        double value, before, wrong = -1e-5, more = -3e-5;
        for (int events = 0; events < 2; events++) {
            Instance unit = fmi3InstantiateCoSimulation("u", token, resources, false, false, events, false, NULL, 0, NULL, hear, NULL);
            NEED(fmi3GetFloat64(unit, &clearance, 1, &before, 1), OK);
            NEED(fmi3EnterInitializationMode(unit, true, tolerance, 0.0, true, stop), OK);
            NEED(fmi3SetFloat64(unit, &clearance, 1, &wrong, 1), OK);
            for (int again = 0; again < 2; again++) NEED(fmi3ExitInitializationMode(unit), ERROR);
            NEED(fmi3SetFloat64(unit, &clearance, 1, &before, 1), OK);
            NEED(fmi3ExitInitializationMode(unit), OK);
            messages = 0;
            if (other) {
                /* What another parameter can put right is refused until it does. */
                NEED(fmi3SetFloat64(unit, &clearance, 1, &wrong, 1), OK);
                for (int again = 0; again < 2; again++) NEED(fmi3GetFloat64(unit, refs, count, values, count), ERROR);
                NEED(fmi3SetFloat64(unit, &other, 1, &more, 1), OK);
                NEED(fmi3GetFloat64(unit, refs, count, values, count), OK);
            } else {
                NEED(fmi3SetFloat64(unit, &clearance, 1, &wrong, 1), ERROR);
                if (messages != 1) return 30;
                NEED(fmi3GetFloat64(unit, &clearance, 1, &value, 1), OK);
                if (value != before) return 31;
            }
            if (events) NEED(fmi3EnterStepMode(unit), OK);
            NEED(fmi3DoStep(unit, 0.0, 0.5 * stop, true, flag, flag, flag, &last), OK);
            fmi3FreeInstance(unit);
        }
    } else if (!strcmp(mode, "wrong")) {
        /* Whatever is called wrongly is told. */
        if (fmi3InstantiateCoSimulation("u", "{no}", resources, 0, 0, 0, 0, NULL, 0, NULL, hear, NULL)) return 20;
        if (fmi3InstantiateCoSimulation("u", NULL, resources, 0, 0, 0, 0, NULL, 0, NULL, hear, NULL)) return 21;
        if (fmi3InstantiateCoSimulation("u", token, "/nowhere/", 0, 0, 0, 0, NULL, 0, NULL, hear, NULL)) return 22;
        if (fmi3InstantiateCoSimulation("u", token, NULL, 0, 0, 0, 0, NULL, 0, NULL, NULL, NULL)) return 23;
        NEED(fmi3DoStep(NULL, 0, 1, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3Reset((void *)0x12345678), ERROR);
        Instance unit = fmi3InstantiateCoSimulation("u", token, resources, false, true, false, false, NULL, 0, NULL, hear, NULL);
        Ref known = first, none = 1000000;
        double value = 1.0;
        const char *text;
        NEED(fmi3DoStep(unit, 0, 1e-3, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3ExitInitializationMode(unit), ERROR);
        NEED(fmi3GetFloat64(unit, &known, 1, &value, 1), ERROR);
        NEED(fmi3EnterInitializationMode(unit, true, tolerance, 1.0, true, 0.5), ERROR);
        NEED(fmi3EnterInitializationMode(unit, true, NAN, 0.0, true, NAN), ERROR);
        NEED(fmi3EnterInitializationMode(unit, true, tolerance, 0.0, true, stop), OK);
        LEAD(0.0);
        NEED(fmi3ExitInitializationMode(unit), OK);
        NEED(fmi3GetFloat64(unit, NULL, 1, &value, 1), ERROR);
        NEED(fmi3GetFloat64(unit, &known, 1, NULL, 1), ERROR);
        NEED(fmi3GetFloat64(unit, &known, 1, &value, 2), ERROR);
        NEED(fmi3GetFloat64(unit, &known, 1, (double *)((char *)&value + 1), 1), ERROR);
        NEED(fmi3GetFloat64(unit, &known, SIZE_MAX, &value, SIZE_MAX), ERROR);
        NEED(fmi3GetFloat64(unit, NULL, 0, NULL, 0), OK);
        NEED(fmi3GetFloat64(unit, &none, 1, &value, 1), ERROR);
        NEED(fmi3SetFloat64(unit, &known, 1, &value, 1), ERROR);
        NEED(fmi3GetString(unit, &known, 1, &text, 1), ERROR);
        NEED(fmi3GetString(unit, NULL, 0, NULL, 0), OK);
        NEED(fmi3EnterConfigurationMode(unit), ERROR);
        NEED(fmi3EnterContinuousTimeMode(unit), ERROR);
        NEED(fmi3SetTime(unit, 1.0), ERROR);
        NEED(fmi3GetOutputDerivatives(unit, &known, 1, (int32_t[]){1}, &value, 1), ERROR);
        NEED(fmi3DoStep(unit, 0.1, 1e-3, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3DoStep(unit, 0.0, -1e-3, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3DoStep(unit, 0.0, NAN, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3DoStep(unit, 0.0, 2 * stop, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3SetFMUState(unit, (void *)0x10), ERROR);
        NEED(fmi3SetFMUState(unit, NULL), ERROR);
        NEED(fmi3FreeFMUState(unit, NULL), OK);
        NEED(fmi3DoStep(unit, 0.0, 1e-3, true, NULL, NULL, NULL, NULL), OK);
        NEED(fmi3Terminate(unit), OK);
        NEED(fmi3DoStep(unit, 1e-3, 1e-3, true, flag, flag, flag, &last), ERROR);
        NEED(fmi3Reset(unit), OK);
        NEED(fmi3EnterInitializationMode(unit, false, 0.0, 0.0, false, 0.0), OK);
        NEED(fmi3ExitInitializationMode(unit), OK);
        /* Without a stop time it goes on for as long as it is asked to. */
        NEED(fmi3DoStep(unit, 0.0, 1.3, true, flag, flag, flag, &last), OK);
        fmi3FreeInstance(unit);
        NEED(fmi3Reset(unit), ERROR);
        fmi3FreeInstance(unit);
        fmi3FreeInstance(NULL);
        printf("%d\n", messages);
    } else {
        return 2;
    }
    return 0;
}

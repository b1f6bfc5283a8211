/* Nanoseconds per call of an entry point of linkwear's C99: the median of the batches, over 64 inputs in turn, as timing.c. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "mechanism.h"

#define BATCHES 101
#define CALLS 2000
#define INPUTS 64

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(void) {
    static double in[INPUTS][IN], out[OUT + 1], w[WORKSPACE + 1], batch[BATCHES];
    for (int i = 0; i < INPUTS; i++) {
#if PARAMETERS > 0
        for (int j = 0; j < PARAMETERS; j++) in[i][j] = TABLE[j].value;
#endif
        in[i][PARAMETERS] = 1e-3 * i;
        for (int j = 0; j < STATES; j++) in[i][PARAMETERS + 1 + j] = START[j] + 1e-4 * i;
    }
    for (int b = 0; b < BATCHES; b++) {
        struct timespec begin, end;
        clock_gettime(CLOCK_MONOTONIC, &begin);
        for (int call = 0; call < CALLS; call++) FUNCTION(in[call % INPUTS], out, w);
        clock_gettime(CLOCK_MONOTONIC, &end);
        batch[b] = ((end.tv_sec - begin.tv_sec) * 1e9 + (end.tv_nsec - begin.tv_nsec)) / CALLS;
    }
    qsort(batch, BATCHES, sizeof batch[0], ascending);
    printf("%.3f\n", batch[BATCHES / 2]);
    return 0;
}

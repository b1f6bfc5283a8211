/* Nanoseconds per call of a function that CasADi wrote: the median of the batches, over 64 inputs in turn. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define BATCHES 101
#define CALLS 2000
#define INPUTS 64

#ifndef FUNCTION
#error "compile with -DFUNCTION=name -DSIZE_ARG -DSIZE_RES -DSIZE_IW -DSIZE_W -DIN -DOUT"
#endif

int FUNCTION(const double **arg, double **res, long long int *iw, double *w, int mem);

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(void) {
    static double in[INPUTS][IN], out[OUT + 1], w[SIZE_W + 1], batch[BATCHES];
    static long long int iw[SIZE_IW + 1];
    const double *arg[SIZE_ARG + 1] = {0};
    double *res[SIZE_RES + 1] = {0};
    for (int i = 0; i < INPUTS; i++)
        for (int j = 0; j < IN; j++)
            if (scanf("%lf", &in[i][j]) != 1) return 1;
    res[0] = out;
    for (int b = 0; b < BATCHES; b++) {
        struct timespec begin, end;
        clock_gettime(CLOCK_MONOTONIC, &begin);
        for (int call = 0; call < CALLS; call++) {
            arg[0] = in[call % INPUTS];
            FUNCTION(arg, res, iw, w, 0);
        }
        clock_gettime(CLOCK_MONOTONIC, &end);
        batch[b] = ((end.tv_sec - begin.tv_sec) * 1e9 + (end.tv_nsec - begin.tv_nsec)) / CALLS;
    }
    qsort(batch, BATCHES, sizeof batch[0], ascending);
    printf("%.3f\n", batch[BATCHES / 2]);
    return 0;
}

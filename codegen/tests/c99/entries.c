/* Answers every entry point at states that come on stdin, as the doubles of this machine. */
#include <stdio.h>

#include "mechanism.h"

typedef void (*entry)(const double *x, double *y, double *w);

static int answer(entry function, size_t inputs, size_t outputs, int states)
{
    static double x[INPUTS], y[OUTPUTS], w[WORKSPACE];
    int i;
    for (i = 0; i < states; ++i) {
        if (fread(x, sizeof x[0], inputs, stdin) != inputs) {
            return 0;
        }
        function(x, y, w);
        if (fwrite(y, sizeof y[0], outputs, stdout) != outputs) {
            return 0;
        }
    }
    return 1;
}

int main(void)
{
    CALLS
    return 0;
}

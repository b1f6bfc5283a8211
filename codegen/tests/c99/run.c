/* Steps a mechanism from its start; writes the flat state after every step. In: step, number of steps. */
#include <stdio.h>

#include "mechanism.h"

int main(void)
{
    double asked[2], parameters[PFX_PARAMETERS + 1] = {0.0}, y[PFX_STATE] = {0.0};
    pfx_memory memory;
    double t = 0.0;
    int i, status;
    if (fread(asked, sizeof asked[0], 2, stdin) != 2) {
        return 1;
    }
    SET_PARAMETERS
    for (i = 0; i < PFX_COORDINATES + PFX_SPEEDS; ++i) {
        y[i] = pfx_start_state[i];
    }
    status = pfx_begin(parameters, t, y, &memory);
    for (i = 1; status == PFX_DONE && i <= (int)asked[1]; ++i) {
        const double next = asked[0] * asked[1] * (i / asked[1]);
        status = pfx_rk4_step(parameters, t, next - t, y, &memory);
        t = next;
        if (fwrite(y, sizeof y[0], PFX_STATE, stdout) != PFX_STATE) {
            return 2;
        }
    }
    return status == PFX_DONE ? 0 : 10 + status;
}

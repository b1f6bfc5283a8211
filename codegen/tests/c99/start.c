/* Takes the start with other parameters. In: time, every parameter. Out: status, coordinates and speeds. */
#include <stdio.h>

#include "mechanism.h"

int main(void)
{
    double asked[1 + PFX_PARAMETERS], y[PFX_STATE], status;
    pfx_memory memory;
    while (fread(asked, sizeof asked[0], 1 + PFX_PARAMETERS, stdin) == 1 + PFX_PARAMETERS) {
        status = pfx_take_start(asked + 1, asked[0], y, &memory);
        if (fwrite(&status, sizeof status, 1, stdout) != 1
            || fwrite(y, sizeof y[0], PFX_COORDINATES + PFX_SPEEDS, stdout) != PFX_COORDINATES + PFX_SPEEDS) {
            return 2;
        }
    }
    return 0;
}

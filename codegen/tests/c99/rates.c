/* Rates of flat states that come on stdin: t, the state, what contacts remember. */
#include <stdio.h>

#include "mechanism.h"

int main(void)
{
    static double question[1 + PFX_STATE + PFX_CONTACT_MEMORY * PFX_CONTACTS];
    static double parameters[PFX_PARAMETERS + 1], rates[PFX_STATE];
    const size_t length = sizeof question / sizeof question[0];
    SET_PARAMETERS
    while (fread(question, sizeof question[0], length, stdin) == length) {
        pfx_right_hand_side(parameters, question[0], question + 1, question + 1 + PFX_STATE, rates);
        if (fwrite(rates, sizeof rates[0], PFX_STATE, stdout) != PFX_STATE) {
            return 1;
        }
    }
    return 0;
}

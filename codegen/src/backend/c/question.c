    for (i = 0; i < PFX_PARAMETERS; ++i) {
        x[i] = parameters[i];
    }
    x[PFX_PARAMETERS] = t;
    for (i = 0; i < PFX_COORDINATES + PFX_SPEEDS; ++i) {
        x[PFX_PARAMETERS + 1 + i] = y[i];
    }

/* What a function returns. */
enum {
    PFX_DONE = 0,
    /* an address is null, or not one of doubles */
    PFX_ADDRESS = 1,
    /* a length is not that of the enumeration */
    PFX_LENGTH = 2,
    /* an input and an output overlap */
    PFX_OVERLAP = 3,
    /* the run cannot begin, or stopped before its end */
    PFX_FAILED = 4,
    /* a defect of linkwear */
    PFX_PANICKED = 5STATUS_OF_MASS
};


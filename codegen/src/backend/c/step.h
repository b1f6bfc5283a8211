/* What a run remembers from step to step; pfx_begin fills it in. Arrays have one place more than they use. */
typedef struct {
    /* largest value that each loop pivot has had */
    double largest_pivots[PFX_ROWS + 1];
    /* longest length that each kept row of the Jacobian has had */
    double row_lengths[PFX_ROWS + 1];
    /* PFX_CONTACT_MEMORY numbers of every joint with clearance */
    double contacts[PFX_CONTACT_MEMORY * PFX_CONTACTS + 1];
} pfx_memory;

/* What became of a step. */
enum {
    PFX_DONE = 0,
    /* the position is singular, or nearly so: the elimination cannot be trusted */
    PFX_NEARLY_SINGULAR = 1,
    /* loops stay open after PFX_CORRECTIONS corrections */
    PFX_OPEN_LOOP = 2,
    /* a number is infinite, or none */
    PFX_NOT_FINITE = 3,
    /* with these parameters the start has to be found anew, which the generator does */
    PFX_OTHER_START = 4
};

//? start
/* Consistent coordinates and speeds at t = 0 with the parameters of the file. */
extern const double pfx_start_state[PFX_COORDINATES + PFX_SPEEDS];

/* Writes the start of the file as it is with these parameters at this time, integrals at zero, and begins a run there. Loops are followed
 * from where they are closed with the parameters of the file. Out: PFX_DONE, or why it cannot: PFX_OTHER_START where loops end apart,
 * given values would not be kept, or journals rest elsewhere. */
int pfx_take_start(const double *parameters, double t, double *y, pfx_memory *memory);

//? contacts
/* The laws of all joints with clearance. In: motions, the first 10 PFX_CONTACTS numbers that pfx_contacts answers; contacts,
 * PFX_CONTACT_MEMORY numbers each. Out: PFX_CONTACT_ANSWER numbers each, the first six of which are what pfx_derivative reads as its
 * wrench. A worn bearing counts as round. */
void pfx_contact_laws(const double *motions, const double *contacts, double *answers);

//.
/* Rates of a flat state y (PFX_STATE numbers), laws of contact included. In: parameters; t [s]; contacts, as pfx_memory has them. */
void pfx_right_hand_side(const double *parameters, double t, const double *y, const double *contacts, double *rates);

/* Begins a run at a flat state near the constraints: puts it onto them and fills in the memory. Out: PFX_DONE, or why it cannot. */
int pfx_begin(const double *parameters, double t, double *y, pfx_memory *memory);

/* A step of the classical Runge-Kutta method of order 4, put onto the constraints, as `linkwear simulate --integrator rk4`: four
 * right-hand sides and at most PFX_CORRECTIONS + 1 evaluations of the loops. Out: PFX_DONE; else why not, and y is as it was. */
int pfx_rk4_step(const double *parameters, double t, double step, double *y, pfx_memory *memory);

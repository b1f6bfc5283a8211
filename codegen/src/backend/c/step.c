/* Fills the input of pfx_derivative at a flat state, asks the laws of contact, and evaluates it. */
static void pfx_slope(const double *parameters, double t, const double *y, const double *contacts, double *answer,
                      double *laws)
{
    double x[PFX_DERIVATIVE_IN];
    double w[PFX_WORKSPACE + 1];
    int i;
QUESTION
//? contacts
    pfx_contacts(x, x + PFX_FORWARD_DYNAMICS_IN, w);
    pfx_contact_laws(x + PFX_FORWARD_DYNAMICS_IN, contacts, laws);
    for (i = 0; i < PFX_CONTACTS; ++i) {
        int k;
        for (k = 0; k < 6; ++k) {
            x[PFX_CONTACTS_IN + 6 * i + k] = laws[PFX_CONTACT_ANSWER * i + k];
        }
    }
//? no contacts
    (void)contacts;
    (void)laws;
//.
    pfx_derivative(x, answer, w);
}

/* Rates of a flat state from an answer of pfx_slope. */
static void pfx_flat_rates(const double *answer, const double *laws, double *rates)
{
    int i;
    for (i = 0; i < PFX_COORDINATES + PFX_SPEEDS; ++i) {
        rates[i] = answer[i];
    }
    rates[PFX_COORDINATES + PFX_SPEEDS] = answer[PFX_DERIVATIVE_OUT - 2];
    rates[PFX_COORDINATES + PFX_SPEEDS + 1] = answer[PFX_DERIVATIVE_OUT - 1];
//? contacts
    for (i = 0; i < PFX_CONTACTS; ++i) {
        int k;
        for (k = 0; k < 4; ++k) {
            rates[PFX_COORDINATES + PFX_SPEEDS + 2 + 4 * i + k] = laws[PFX_CONTACT_ANSWER * i + 6 + k];
        }
    }
//? no contacts
    (void)laws;
//.
}

void pfx_right_hand_side(const double *parameters, double t, const double *y, const double *contacts, double *rates)
{
    double answer[PFX_DERIVATIVE_OUT];
    double laws[PFX_CONTACT_ANSWER * PFX_CONTACTS + 1];
    pfx_slope(parameters, t, y, contacts, answer, laws);
    pfx_flat_rates(answer, laws, rates);
}

/* Whether all are numbers, and none is infinite. */
static int pfx_is_finite(const double *values, int count)
{
    int i;
    for (i = 0; i < count; ++i) {
        if (!(fabs(values[i]) < HUGE_VAL)) {
            return 0;
        }
    }
    return 1;
}

//? rows
/* Notes pivots; the smallest one relative to the largest value that it has had. */
static double pfx_regularity(const double *pivots, double *largest)
{
    double noise = 0.0;
    double least = 1.0;
    int i;
    for (i = 0; i < PFX_ROWS; ++i) {
        if (largest[i] < pivots[i] && pivots[i] < HUGE_VAL) {
            largest[i] = pivots[i];
        }
        noise = noise < largest[i] ? largest[i] : noise;
    }
    noise = 1e-13 * noise;
    for (i = 0; i < PFX_ROWS; ++i) {
        least = pivots[i] < least * largest[i] ? pivots[i] / largest[i] : least;
        least = noise < pivots[i] ? least : 0.0;
    }
    return least;
}

/* Scalar product in four running sums. */
static double pfx_dot(const double *a, const double *b, int count)
{
    double sums[4] = {0.0, 0.0, 0.0, 0.0};
    double rest = 0.0;
    int i;
    for (i = 0; i + 4 <= count; i += 4) {
        int k;
        for (k = 0; k < 4; ++k) {
            sums[k] += a[i + k] * b[i + k];
        }
    }
    for (; i < count; ++i) {
        rest += a[i] * b[i];
    }
    return (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest;
}

/* Largest magnitude; no number if one is none. */
static double pfx_largest(const double *values, int count)
{
    double most = 0.0;
    int i;
    for (i = 0; i < count; ++i) {
        most = fabs(values[i]) <= most ? most : fabs(values[i]);
        if (values[i] != values[i]) {
            return values[i];
        }
    }
    return most;
}

/* Residuals of the loops: all rows, speeds of kept rows, their Jacobian; the longest row of each is remembered. */
static void pfx_loops(const double *parameters, double t, const double *y, double *loops, pfx_memory *memory)
{
    double x[PFX_CLOSURE_IN];
    double w[PFX_WORKSPACE + 1];
    const double *const jacobian = loops + PFX_ALL_ROWS + PFX_ROWS;
    int i;
QUESTION
    pfx_closure(x, loops, w);
    for (i = 0; i < PFX_ROWS; ++i) {
        const double *const row = jacobian + PFX_SPEEDS * i;
        const double length = sqrt(pfx_dot(row, row, PFX_SPEEDS));
        memory->row_lengths[i] = length > memory->row_lengths[i] ? length : memory->row_lengths[i];
    }
}

/* L D L^T of the scaled Jacobian times its transpose. */
typedef struct {
    double rows[PFX_ROWS * PFX_SPEEDS + 1];
    double scales[PFX_ROWS];
    double factors[PFX_ROWS * PFX_ROWS];
} pfx_gram;

/* Factors it; 0 if its rows are too nearly dependent. */
static int pfx_factor(const double *jacobian, const pfx_memory *memory, pfx_gram *gram)
{
    double most[2] = {0.0, 0.0};
    double work[PFX_ROWS] = {0.0};
    double smallest = HUGE_VAL;
    double largest = 0.0;
    int i, j;
    for (i = 0; i < PFX_ROWS; ++i) {
        double *const of_kind = most + pfx_rows[pfx_kept[i]].angular;
        *of_kind = *of_kind < memory->row_lengths[i] ? memory->row_lengths[i] : *of_kind;
    }
    for (i = 0; i < PFX_ROWS; ++i) {
        const double least = 1e-3 * most[pfx_rows[pfx_kept[i]].angular];
        double length = memory->row_lengths[i];
        length = length < least ? least : length;
        length = length < DBL_MIN ? DBL_MIN : length;
        gram->scales[i] = 1.0 / length;
        for (j = 0; j < PFX_SPEEDS; ++j) {
            gram->rows[PFX_SPEEDS * i + j] = jacobian[PFX_SPEEDS * i + j] * (gram->scales[i] * pfx_sizes[j]);
        }
    }
    for (i = 0; i < PFX_ROWS; ++i) {
        for (j = 0; j <= i; ++j) {
            gram->factors[PFX_ROWS * i + j] =
                pfx_dot(gram->rows + PFX_SPEEDS * i, gram->rows + PFX_SPEEDS * j, PFX_SPEEDS);
        }
    }
    for (i = 0; i < PFX_ROWS; ++i) {
        double *const row = gram->factors + PFX_ROWS * i;
        double pivot;
        for (j = 0; j < i; ++j) {
            work[j] = row[j] - pfx_dot(work, gram->factors + PFX_ROWS * j, j);
        }
        pivot = row[i];
        for (j = 0; j < i; ++j) {
            row[j] = work[j] / gram->factors[PFX_ROWS * j + j];
            pivot -= row[j] * work[j];
        }
        row[i] = pivot;
        if (pivot != pivot) {
            return 0;
        }
        smallest = pivot < smallest ? pivot : smallest;
        largest = largest < pivot ? pivot : largest;
    }
    return smallest / largest > 1e-8;
}

/* The shortest motion that takes a residual away. */
static void pfx_solve(const pfx_gram *gram, const double *residual, double *delta)
{
    double right[PFX_ROWS];
    int i, j;
    for (i = 0; i < PFX_ROWS; ++i) {
        right[i] = -gram->scales[i] * residual[i];
    }
    for (i = 0; i < PFX_ROWS; ++i) {
        right[i] -= pfx_dot(gram->factors + PFX_ROWS * i, right, i);
    }
    for (i = 0; i < PFX_ROWS; ++i) {
        right[i] /= gram->factors[PFX_ROWS * i + i];
    }
    for (i = PFX_ROWS - 1; i >= 0; --i) {
        for (j = 0; j < i; ++j) {
            right[j] += -right[i] * gram->factors[PFX_ROWS * i + j];
        }
    }
    for (j = 0; j < PFX_SPEEDS; ++j) {
        delta[j] = 0.0;
    }
    for (i = 0; i < PFX_ROWS; ++i) {
        for (j = 0; j < PFX_SPEEDS; ++j) {
            delta[j] += right[i] * gram->rows[PFX_SPEEDS * i + j];
        }
    }
    for (j = 0; j < PFX_SPEEDS; ++j) {
        delta[j] *= pfx_sizes[j];
    }
}

/* Puts a flat state onto the constraints: at most PFX_CORRECTIONS corrections of positions and one of speeds. */
static int pfx_put_on(const double *parameters, double t, double *y, double strictness, pfx_memory *memory)
{
    double loops[PFX_CLOSURE_OUT];
    double residual[PFX_ROWS];
    double delta[PFX_SPEEDS + 1];
    pfx_gram gram;
    const double *const speeds = loops + PFX_ALL_ROWS;
    const double *const jacobian = speeds + PFX_ROWS;
    double *const v = y + PFX_COORDINATES;
    double before = HUGE_VAL;
    double rounding, own, tolerance, least;
    int is_factored = 0;
    int i, iteration;
    pfx_normalize(y);
    rounding = pfx_largest(y, PFX_COORDINATES);
    rounding = DBL_EPSILON * (rounding < 1.0 ? 1.0 : rounding);
    own = 1e-14 * strictness;
    tolerance = (own < 0.5 * rounding ? 0.5 * rounding : own) + rounding * strictness;
    for (iteration = 0;; ++iteration) {
        double size;
        int is_stalled;
        pfx_loops(parameters, t, y, loops, memory);
        for (i = 0; i < PFX_ROWS; ++i) {
            residual[i] = loops[pfx_kept[i]];
        }
        size = pfx_largest(residual, PFX_ROWS);
        if (iteration == 0 && size <= own) {
            break;
        }
        is_stalled = size > 0.25 * before;
        if (size <= tolerance || (is_stalled && size <= 1e-11)) {
            break;
        }
        if (size != size || iteration == PFX_CORRECTIONS) {
            return PFX_OPEN_LOOP;
        }
        if (!is_factored || is_stalled) {
            if (!pfx_factor(jacobian, memory, &gram)) {
                return PFX_NEARLY_SINGULAR;
            }
            is_factored = 1;
        }
        before = size;
        pfx_solve(&gram, residual, delta);
        pfx_advance(y, delta);
    }
    if (!(pfx_largest(loops, PFX_ALL_ROWS) <= 1e-7)) {
        return PFX_OPEN_LOOP;
    }
    least = 1e-13 * strictness;
    least = least < 0.5 * DBL_EPSILON ? 0.5 * DBL_EPSILON : least;
    tolerance = pfx_largest(v, PFX_SPEEDS);
    tolerance = least * (tolerance < 1.0 ? 1.0 : tolerance);
    if (pfx_largest(speeds, PFX_ROWS) <= tolerance) {
        return PFX_DONE;
    }
    if (!is_factored && !pfx_factor(jacobian, memory, &gram)) {
        return PFX_NEARLY_SINGULAR;
    }
    pfx_solve(&gram, speeds, delta);
    for (i = 0; i < PFX_SPEEDS; ++i) {
        v[i] += delta[i];
    }
    return PFX_DONE;
}
//.

int pfx_begin(const double *parameters, double t, double *y, pfx_memory *memory)
{
    int i;
//? rows
    for (i = 0; i < PFX_ROWS; ++i) {
        memory->largest_pivots[i] = 0.0;
        memory->row_lengths[i] = 0.0;
    }
//.
    for (i = 0; i < PFX_CONTACT_MEMORY * PFX_CONTACTS; ++i) {
        memory->contacts[i] = 0.0;
    }
//? contacts
    {
        double answer[PFX_DERIVATIVE_OUT];
        double laws[PFX_CONTACT_ANSWER * PFX_CONTACTS];
        pfx_slope(parameters, t, y, memory->contacts, answer, laws);
        for (i = 0; i < PFX_CONTACTS; ++i) {
            const double *const law = laws + PFX_CONTACT_ANSWER * i;
            double *const contact = memory->contacts + PFX_CONTACT_MEMORY * i;
            contact[1] = 0.0 < law[10] ? 1.0 : 0.0;
            contact[2] = 0.0 < law[10] && 0.0 < law[11] ? law[11] : 0.0;
        }
    }
//.
//? rows
    {
        double loops[PFX_CLOSURE_OUT];
        pfx_normalize(y);
        pfx_loops(parameters, t, y, loops, memory);
        if (pfx_largest(loops, PFX_ALL_ROWS + PFX_ROWS) <= 1e-9) {
            return PFX_DONE;
        }
    }
    return pfx_put_on(parameters, t, y, 1.0, memory);
//? no rows
    (void)parameters;
    (void)t;
    pfx_normalize(y);
    return PFX_DONE;
//.
}

//? start
/* Where assembly starts from. */
static void pfx_wish(const double *parameters, double t, double *answer)
{
    double x[PFX_START_IN];
    double w[PFX_WORKSPACE + 1];
    int i;
    for (i = 0; i < PFX_PARAMETERS; ++i) {
        x[i] = parameters[i];
    }
    x[PFX_PARAMETERS] = t;
    pfx_start(x, answer, w);
}

//? start contacts
/* What decides where journals rest. */
static void pfx_rest(const double *parameters, double t, const double *y, double *answer)
{
    double x[PFX_CONTACTS_IN];
    double w[PFX_WORKSPACE + 1];
    int i;
QUESTION
    pfx_wish(parameters, t, answer);
    answer += PFX_START_OUT;
    pfx_prescribed(x, answer, w);
    answer += PFX_PRESCRIBED_OUT;
    pfx_closure(x, answer, w);
    answer += PFX_CLOSURE_OUT;
    pfx_contacts(x, answer, w);
}

//? start loops
/* Whether values that the file gives are kept. */
static int pfx_are_kept(const double *wish, const double *y)
{
    int i;
    for (i = 0; i < PFX_COORDINATES + PFX_SPEEDS; ++i) {
        const double size = fabs(wish[i]) < 1.0 ? 1.0 : fabs(wish[i]);
        if (pfx_is_given[i] && !(fabs(y[i] - wish[i]) <= 1e-8 * size)) {
            return 0;
        }
    }
    return 1;
}

/* Goes from the start of the file to these parameters and this time in so many parts, its loops closed all the way. */
static int pfx_follow(const double *known, const double *parameters, double t, int parts, double *y, pfx_memory *memory)
{
    double way[PFX_PARAMETERS + 1];
    int part, i, status = PFX_DONE;
    for (i = 0; i < PFX_COORDINATES + PFX_SPEEDS; ++i) {
        y[i] = pfx_start_state[i];
    }
    for (part = 1; part <= parts && status == PFX_DONE; ++part) {
        const double share = part / (double)parts;
        for (i = 0; i < PFX_PARAMETERS; ++i) {
            way[i] = part == parts ? parameters[i] : known[i] + share * (parameters[i] - known[i]);
        }
        status = pfx_begin(way, part == parts ? t : share * t, y, memory);
    }
    return status;
}

//? start
int pfx_take_start(const double *parameters, double t, double *y, pfx_memory *memory)
{
    double known[PFX_PARAMETERS + 1] = {0.0};
    int is_known = t == 0.0;
    int i;
//? parameters
    pfx_set_parameters(&pfx_default_parameters, known);
//? start
    for (i = 0; i < PFX_PARAMETERS; ++i) {
        is_known = is_known && parameters[i] == known[i];
    }
    for (i = 0; i < PFX_STATE; ++i) {
        y[i] = i < PFX_COORDINATES + PFX_SPEEDS ? pfx_start_state[i] : 0.0;
    }
    if (is_known) {
        return pfx_begin(parameters, t, y, memory);
    }
//? start contacts
    {
        double rests[2][PFX_START_OUT + PFX_PRESCRIBED_OUT + PFX_CLOSURE_OUT + PFX_CONTACTS_OUT];
        pfx_rest(known, 0.0, y, rests[0]);
        pfx_rest(parameters, t, y, rests[1]);
        for (i = 0; i < (int)(sizeof rests[0] / sizeof rests[0][0]); ++i) {
            if (!(rests[0][i] == rests[1][i])) {
                return PFX_OTHER_START;
            }
        }
    }
    return pfx_begin(parameters, t, y, memory);
//? start loops
    {
        double wish[PFX_START_OUT];
        int parts = 1, status;
        /* A start too far away stays open: in parts it is near. */
        do {
            status = pfx_follow(known, parameters, t, parts, y, memory);
            parts *= 4;
        } while (status != PFX_DONE && parts <= 4096);
        pfx_wish(parameters, t, wish);
        for (i = 0; i < PFX_SPEEDS; ++i) {
            y[PFX_COORDINATES + i] = wish[PFX_COORDINATES + i];
        }
        status = status == PFX_DONE ? pfx_begin(parameters, t, y, memory) : status;
        return status == PFX_DONE && pfx_are_kept(wish, y) ? PFX_DONE : PFX_OTHER_START;
    }
//? start open
    pfx_wish(parameters, t, y);
    return pfx_begin(parameters, t, y, memory);
//? start
}

//.
int pfx_rk4_step(const double *parameters, double t, double step, double *y, pfx_memory *memory)
{
    double stage[PFX_STATE];
    double rates[4][PFX_STATE];
    double answer[PFX_DERIVATIVE_OUT];
    double laws[PFX_CONTACT_ANSWER * PFX_CONTACTS + 1];
//? contacts
    double depths[2 * PFX_CONTACTS] = {0.0};
//.
//? rows
    double nearness = 1.0;
    int status;
//.
    int i, k;
    for (k = 0; k < 4; ++k) {
        const double part = k == 3 ? step : 0.5 * step;
        for (i = 0; i < PFX_STATE; ++i) {
            stage[i] = k == 0 ? y[i] : y[i] + part * rates[k - 1][i];
        }
        pfx_slope(parameters, k == 0 ? t : t + part, stage, memory->contacts, answer, laws);
        if (!pfx_is_finite(answer, PFX_DERIVATIVE_OUT)) {
            return PFX_NOT_FINITE;
        }
//? rows
        nearness = pfx_regularity(answer + PFX_DERIVATIVE_OUT - 2 - PFX_ROWS, memory->largest_pivots);
        if (nearness < 0.05) {
            return PFX_NEARLY_SINGULAR;
        }
//.
        pfx_flat_rates(answer, laws, rates[k]);
//? contacts
        for (i = 0; k == 0 && i < PFX_CONTACTS; ++i) {
            depths[2 * i] = laws[PFX_CONTACT_ANSWER * i + 10];
            depths[2 * i + 1] = laws[PFX_CONTACT_ANSWER * i + 11];
        }
//.
    }
    for (i = 0; i < PFX_STATE; ++i) {
        stage[i] = y[i] + (step / 6.0) * ((rates[0][i] + rates[3][i]) + 2.0 * (rates[1][i] + rates[2][i]));
    }
//? rows
    status = pfx_put_on(parameters, t + step, stage, nearness, memory);
    if (status != PFX_DONE) {
        return status;
    }
//? no rows
    pfx_normalize(stage);
//.
    if (!pfx_is_finite(stage, PFX_STATE)) {
        return PFX_NOT_FINITE;
    }
//? contacts
    /* A gap that closed within the step remembers the speed at the crossing, both taken as linear. */
    pfx_slope(parameters, t + step, stage, memory->contacts, answer, laws);
    for (i = 0; i < PFX_CONTACTS; ++i) {
        const double *const law = laws + PFX_CONTACT_ANSWER * i;
        double *const contact = memory->contacts + PFX_CONTACT_MEMORY * i;
        const double rise = law[10] - depths[2 * i];
        double crossed = -depths[2 * i] / (0.0 < rise ? rise : 1.0);
        double speed;
        crossed = crossed < 0.0 ? 0.0 : crossed;
        crossed = 0.0 < rise ? (1.0 < crossed ? 1.0 : crossed) : 1.0;
        speed = depths[2 * i + 1] + crossed * (law[11] - depths[2 * i + 1]);
        speed = 0.5 < contact[1] ? contact[2] : (speed < 0.0 ? 0.0 : speed);
        contact[1] = 0.0 < law[10] ? 1.0 : 0.0;
        contact[2] = 0.0 < law[10] ? speed : 0.0;
    }
//.
    for (i = 0; i < PFX_STATE; ++i) {
        y[i] = stage[i];
    }
    return PFX_DONE;
}

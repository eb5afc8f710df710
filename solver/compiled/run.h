/* The cases of a batch, in groups that share a mesh, a table and the interface of the layer. */
typedef struct { State *states; int64_t *list, *sorted; } Run;
static int kind_of(const Batch *b, const State *s, int64_t i, int by_octave) {
    if (!b->layered) return 0;
    int kind = (b->n[i] > 2 ? 2 : 0) + (b->bonded[i] != 0);
    if (!by_octave) return kind;
    union { double value; uint64_t bits; } h_a = {b->h[i] / s[i].a};
    int64_t octave = (int64_t)(h_a.bits >> 52) - 1023 - b->first_octave;
    if (octave >= b->octaves) octave = b->octaves - 1;
    return octave < 0 ? -1 : kind + 4 * (int)octave;                          /* a film, or not a number: handed back */
}
static void by_kinds(Group *c, const Run *run, int64_t count, int by_octave, void (*work)(Group *, State *)) {
    const Batch *b = c->b;
    State *s = run->states;
    int64_t ends[KINDS + 1] = {0}, *list = run->list, *order = run->sorted, from = 0;
    for (int64_t j = 0; j < count; j++) {
        int kind = kind_of(b, s, list[j], by_octave);
        if (kind < 0) s[list[j]].rung = -1;
        else ends[kind + 1]++;
    }
    for (int k = 0; k < KINDS; k++) ends[k + 1] += ends[k];
    for (int64_t j = 0; j < count; j++)
        if (s[list[j]].rung >= 0) order[ends[kind_of(b, s, list[j], by_octave)]++] = list[j];
    for (int k = 0; k < KINDS; from = ends[k++]) {
        if (ends[k] == from) continue;
        const Table **of_kind = c->tables + k / 2;
        int needed = b->layered && by_octave;
        if (needed && !*of_kind) *of_kind = b->table(c->on.n, k / 4 + b->first_octave, (k & 2) != 0);
        c->table = needed ? *of_kind : 0;
        if (c->table) c->on.rows = &c->table->own, c->fine.rows = &c->table->fine;
        for (int64_t j = from; j < ends[k]; j += W) {
            load_cases(c, order + j, (int)(ends[k] - j < W ? ends[k] - j : W));
            if (!needed || c->table) work(c, s);
            else for (int l = 0; l < c->count; l++) s[c->index[l]].rung = -1;
        }
    }
}
/* The cases of a mesh at a stage, by their kinds. */
static int64_t at_stage(Group *c, Run *run, int64_t rung, int stage, void (*work)(Group *, State *)) {
    int64_t count = 0;
    for (int64_t i = 0; i < c->b->size; i++)
        if (run->states[i].rung == rung && run->states[i].stage == stage) run->list[count++] = i;
    if (count) by_kinds(c, run, count, stage != AT_GUESS, work);
    return count;
}
static void on_rung(Group *c, const Batch *b, Run *run, int64_t r) {
    int64_t i = 0; while (i < b->size && run->states[i].rung != r) i++;
    const Mesh *m = c->mesh = i < b->size ? b->mesh(b->ladder[r]) : 0;        /* it takes long to make */
    if (!m) return;
    memset(c->tables, 0, sizeof(c->tables));
    c->on.n = m->n, c->on.s = m->s, c->on.w = m->w, c->on.half_space = m->K;
    c->fine.n = b->ladder[r + 1], c->fine.s = m->fine_s, c->fine.w = m->fine_w, c->fine.half_space = m->fine_K;
    at_stage(c, run, r, AT_GUESS, first_guess);
    c->last = 0;
    for (int done = 0; done <= b->steps && at_stage(c, run, r, AT_STEPS, sweep); done++) c->last = done + 1 == b->steps;
    at_stage(c, run, r, AT_FINISH, finish);
}
/* Solve the cases; 0 if there is no memory. `most` points of profiles and others, a multiple of 32. */
static int solve(const Batch *b, int64_t most) {
    int64_t size = b->size, vectors = 2 * most + (5 * most > WAVES ? 5 * most : WAVES);
    int64_t bytes = 64 + (int64_t)sizeof(Group) + vectors * (int64_t)sizeof(V);
    char *block = malloc((size_t)(bytes + size * (int64_t)(sizeof(State) + 16 + MOST_NODES * 8)));
    if (!block) return 0;
    Group *c = (Group *)(((uintptr_t)block + 63) & ~(uintptr_t)63);
    memset(&c->layer, 0, sizeof(Layer));
    c->b = b, c->law.name = b->law;
    c->points = (V *)(c + 1), c->pressures = c->points + most, c->room = c->pressures + most;
    State *states = (State *)(c->points + vectors);
    Run run = {states, (int64_t *)(states + size), (int64_t *)(states + size) + size};
    double *y = (double *)(run.sorted + size);
    for (int64_t i = 0; i < size; i++) states[i] = (State){.y = y + i * MOST_NODES, .stage = AT_GUESS};
    at_stage(c, &run, 0, AT_GUESS, begin);
    for (int64_t r = 0; r + 1 < b->rungs; r++) on_rung(c, b, &run, r);
    free(block);
    return 1;
}

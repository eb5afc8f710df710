/* The cases of a batch, in groups that share a mesh, a table and the interface of the layer. */
static int kind_of(const Batch *b, const States *s, int64_t i, int by_octave) {
    if (!b->layered) return 0;
    int kind = (b->n[i] > 2 ? 2 : 0) + (b->bonded[i] != 0);
    if (!by_octave) return kind;
    union { double value; uint64_t bits; } h_a = {b->h[i] / s->a[i]};
    int64_t octave = (int64_t)(h_a.bits >> 52) - 1023 - b->first_octave;
    if (octave >= b->octaves) octave = b->octaves - 1;
    return octave < 0 ? -1 : kind + 4 * (int)octave;                           /* a film, or not a number: handed back */
}
static void by_kinds(Group *c, States *s, const int64_t *list, int64_t count, int by_octave, void (*work)(Group *, States *)) {
    const Batch *b = c->b;
    int64_t ends[KINDS + 1] = {0}, *order = s->sorted, from = 0;
    for (int64_t j = 0; j < count; j++) {
        int kind = kind_of(b, s, list[j], by_octave);
        if (kind < 0) s->rung[list[j]] = -1;
        else ends[kind + 1]++;
    }
    for (int k = 0; k < KINDS; k++) ends[k + 1] += ends[k];
    int64_t total = ends[KINDS];
    for (int64_t j = 0; j < count; j++)
        if (s->rung[list[j]] >= 0) order[ends[kind_of(b, s, list[j], by_octave)]++] = list[j];
    for (int k = 0; k < KINDS && from < total; from = ends[k++]) {
        if (ends[k] == from) continue;
        c->table = 0;
        if (b->layered && by_octave) {
            const Table **of_kind = c->tables + k / 2;
            if (!*of_kind) *of_kind = b->table(c->on.n, k / 4 + b->first_octave, (k & 2) != 0);
            c->table = *of_kind;
        }
        if (b->layered && by_octave && !c->table) {
            for (int64_t j = from; j < ends[k]; j++) s->rung[order[j]] = -1;
            continue;
        }
        if (c->table) c->on.rows = &c->table->own, c->fine.rows = &c->table->fine;
        for (int64_t j = from; j < ends[k]; j += W) {
            load_cases(c, order + j, (int)(ends[k] - j < W ? ends[k] - j : W));
            work(c, s);
        }
    }
}
static int64_t those(const Batch *b, States *s, int64_t rung, int fresh) {
    int64_t count = 0;
    for (int64_t i = 0; i < b->size; i++)
        if (s->rung[i] == rung && s->fresh[i] == fresh) s->list[count++] = i;
    return count;
}
static void step(Group *c, States *s) { sweep(c, s, 0); }
static void last_step(Group *c, States *s) { sweep(c, s, 1); }

static void on_rung(Group *c, States *s, int64_t r) {
    const Batch *b = c->b;
    int64_t count;
    const Mesh *m = c->mesh = b->mesh(b->ladder[r]);
    if (!m) return;
    for (int k = 0; k < KINDS / 2; k++) c->tables[k] = 0;
    c->on.n = m->n, c->on.s = m->s, c->on.w = m->w, c->on.half_space = m->K;
    c->fine.n = b->ladder[r + 1], c->fine.s = m->fine_s, c->fine.w = m->fine_w, c->fine.half_space = m->fine_K;
    if ((count = those(b, s, r, 1))) by_kinds(c, s, s->list, count, 0, first_guess);
    for (int done = 0; done <= b->steps && (count = those(b, s, r, 0)); done++)
        by_kinds(c, s, s->list, count, 1, done < b->steps ? step : last_step);
    if ((count = those(b, s, r, 2))) by_kinds(c, s, s->list, count, 1, finish);
    if (b->points && !b->layered && (count = those(b, s, r, 3))) by_kinds(c, s, s->list, count, 1, profile);
}
/* Solve the cases; 0 if there is no memory. `most` points of profiles and others, a multiple of 32. */
static int solve(const Batch *b, int64_t most) {
    int64_t size = b->size, vectors = 2 * most + (5 * most > WAVES ? 5 * most : WAVES);
    char *block = malloc(64 + sizeof(Group) + (size_t)vectors * sizeof(V) + (size_t)size * (MOST_NODES + 11) * 8);
    if (!block) return 0;
    Group *c = (Group *)(((uintptr_t)block + 63) & ~(uintptr_t)63);
    memset(&c->layer, 0, sizeof(Layer));
    c->b = b;
    c->points = (V *)(c + 1), c->pressures = c->points + most, c->room = c->pressures + most;
    double *numbers = (double *)(c->points + vectors);
    States s = {.scalars = b->scalars, .y = numbers}, *states = &s;
    double **arrays[] = {&s.eta, &s.a, &s.soft, &s.residual, &s.before, &s.edge_q};
    numbers += size * MOST_NODES;
    for (int i = 0; i < 6; i++, numbers += size) *arrays[i] = numbers;
    s.list = (int64_t *)numbers, s.sorted = s.list + size, s.rung = s.sorted + size;
    s.count = (int32_t *)(s.rung + size), s.fresh = s.count + size;
    for (int64_t i = 0; i < size; i++) s.list[i] = i, s.count[i] = 0, s.fresh[i] = 1, s.rung[i] = 0;
    by_kinds(c, states, s.list, size, 0, begin);
    for (int64_t r = 0; r + 1 < b->rungs; r++) on_rung(c, states, r);
    free(block);
    return 1;
}

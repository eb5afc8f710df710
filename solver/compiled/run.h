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
static V *room_of(V **room, int64_t count) { V *at = *room; *room += count; return at; }

static void equation_in(Equation *e, V **room) {
    V **arrays[] = {&e->y, &e->q, &e->g, &e->dq, &e->dg, &e->Kq, &e->slope, &e->F};
    for (int i = 0; i < 8; i++) *arrays[i] = room_of(room, MOST_NODES + 32);
}
/* Solve the cases; 0 if there is no memory. `most_points` and `most_waves`: the largest numbers of points and k. */
static int solve(const Batch *b, int64_t most_points, int64_t most_waves) {
    int64_t n = MOST_NODES + 32, size = b->size, large = ((most_points > n ? most_points : n) + 31) / 32 * 32;
    int64_t vectors = 20 * n + 2 * n * n + 5 * most_waves + 8 * large + 256;
    if (5 * large > most_waves) vectors += 5 * large;
    char *block = malloc((size_t)vectors * sizeof(V) + 64 + (size_t)size * (MOST_NODES * 8 + 11 * 8));
    if (!block) return 0;
    V *room = (V *)(((uintptr_t)block + 63) & ~(uintptr_t)63), *begun = room;
    Group c = {.b = b};
    equation_in(&c.on, &room);
    equation_in(&c.fine, &room);
    c.K = room_of(&room, n * n); c.A = room_of(&room, n * n);
    c.L1 = room_of(&room, 128); c.uL = room_of(&room, 128);
    c.weights = room_of(&room, most_waves); c.slopes = room_of(&room, most_waves); c.waves = room_of(&room, most_waves);
    c.d_eta = room_of(&room, n); c.step = room_of(&room, n); c.missed = room_of(&room, n);
    c.points = room_of(&room, large); c.pressures = room_of(&room, large);
    c.room = room;
    double *numbers = (double *)(begun + vectors);
    States s = {.scalars = b->scalars};
    s.y = numbers; numbers += size * MOST_NODES;
    double **arrays[] = {&s.eta, &s.a, &s.soft, &s.residual, &s.before, &s.edge_q};
    for (int i = 0; i < 6; i++, numbers += size) *arrays[i] = numbers;
    int64_t *whole = (int64_t *)numbers;
    s.list = whole; s.sorted = whole + size; s.rung = whole + 2 * size;
    s.count = (int32_t *)(whole + 3 * size); s.fresh = s.count + size;
    for (int64_t i = 0; i < size; i++) s.list[i] = i, s.count[i] = 0, s.fresh[i] = 1, s.rung[i] = 0;
    by_kinds(&c, &s, s.list, size, 0, begin);
    for (int64_t r = 0; r + 1 < b->rungs; r++) on_rung(&c, &s, r);
    free(block);
    return 1;
}

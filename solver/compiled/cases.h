/* What becomes of the cases: where they begin, their errors, and their numbers. solver/rough: start.py, error.py,
   results.py, answer.py, adaptive.py. A case for which anything but convergence may come out is handed back. */
typedef struct { V value[7]; } Quantities;                                     /* a, P, D, p0, p_max, Ar_An, A0 */
static Quantities quantities(const Group *c, const Equation *e) {              /* (5), (11)-(14) */
    int64_t n = e->n, last = n - 1;
    V a = e->a, area = all(0), load = against(e->w, e->q, n);
    for (int64_t i = 0; i < n; i++) area += e->w[i] * area_of(&c->law, e->y[i], e->q[i]);
    return (Quantities){{a, 2 * PI * a * a * c->law.p_star * load, a * a / 2 * (1 + e->X * e->Kq[n]),
                         c->law.p_star * e->q[last], c->law.p_star * peak_of(&c->law, e->y[last], e->q[last]), 2 * area,
                         c->law.A_star * e->g[last]}};
}
/* The relative change by a compliance in the ring between the edge and the first node. */
static V added_in_ring(V t, double s1, V beta) {
    V end = 2 * power(t / (s1 * s1), 2 / (3 - beta)), wide = vlog(1 + 1 / end), less = (1 - beta) / 2, falls;
    V power_of_end = power(end, -less);
    exponential(-less * wide, &falls);
    V integral = pick(less > 0, power_of_end * -falls / pick(less > 0, less, all(1.0)), wide);
    return pick(t > 0, t * integral, all(0));
}
static V unseen(const Group *c, V a, double s1) {                              /* Hankel.unseen */
    V h_a = c->layer.h / a, begin = h_a / (s1 * s1), low = vlog(begin), step = (vlog(all(45.0)) - low) / 63;
    I thin = h_a < 45.0 * s1 * s1;
    if (!c->b->layered || !any(thin)) return all(0);
    V first = all(0), sum = all(0), f = all(0);
    for (int i = 0; i < 64; i++) {
        V u = i ? vexp(low + i * step) : begin, level = vlog(whole(&c->layer, u) * (1 + c->layer.m));
        if (!i) first = level;
        V before = f;
        f = size_of(level - first) / u;
        if (i) sum += (f + before) / 2 * step;
    }
    return pick(thin, (sum + f) * h_a / PI, all(0));
}
static V missed_ring(const Group *c) {
    static const double enclosing[] = {[LOAD] = 0.2, [RADIUS] = 0.5, [DEPTH] = 0.25};
    const Equation *e = &c->on;
    double s1 = e->s[0];
    V body = e->X * softness(c, e->a * s1 * s1), springs = e->Y / body, asperities = e->Z * e->g[0] / (body * e->q[0]);
    I blind = springs + asperities < 16.0 * s1 * s1;
    if (!any(blind)) return all(0);
    V beta = c->b->law == POWER_LAW ? c->law.beta : all(2.0 / 3);
    V ring = added_in_ring(springs, s1, all(1.0)) + added_in_ring(asperities, s1, beta);
    return pick(blind, enclosing[c->b->control] * ring, all(0));
}
static V moved_edge(const Group *c) {
    const Equation *e = &c->fine;
    V largest = all(0), shift = all(0);
    for (int64_t i = 0; i < e->n; i++) largest = most(c->q_start[i], largest);
    for (int64_t i = 0; i < e->n; i++) {
        double s2 = e->s[i] * e->s[i];
        V share = clip(c->on.Z * c->g_start[i] / s2, all(0.0), all(1.0));
        V floor = most(c->q_start[i], 0.02 * s2 * largest);
        V moved = (1 - share) * size_of(e->q[i] - c->q_start[i]) / floor + share * size_of(e->g[i] / c->g_start[i] - 1);
        shift = most(s2 * pick(moved > 1e-8, moved, all(0.0)), shift);
    }
    return shift;
}
/* The error of Ar/An that both meshes may miss alike: completed of error.py. */
static V completed(Group *c, V area, V error) {
    const Equation *e = &c->on;
    double s1 = e->s[0];
    V first = area_of(&c->law, e->y[0], e->q[0]), last = area_of(&c->law, e->y[e->n - 1], e->q[e->n - 1]);
    error = most(error, pick(first > 0.05, 8.0 * s1 * s1 / 2 * first / area, all(0.0)));
    I sharp = (last > 0.7) | (c->law.beta < 0.45);                             /* beta is 1 but of power laws */
    if (!any(sharp)) return error;
    const Points *p = &c->mesh->more;
    V other = all(0);
    interpolate(c, p, c->b->layered ? c->table->J_more : 0, 1e-13, c->points);
    for (int64_t i = 0; i < p->m; i++)
        other += p->w[i] * area_of(&c->law, c->points[i], curve_of(&c->law, c->points[i]).q);
    return pick(sharp, most(error, 2 * size_of(other / area - 1)), error);
}
static void load_state(Group *c, State *s) {
    c->on.eta = OF_STATES(s, eta);
    c->on.a = OF_STATES(s, a);
    for (int64_t i = 0; i < c->on.n; i++) EACH(l) c->on.y[i][l] = s[c->index[l]].y[i];
}
/* A step of Newton's method for each case of a group. A case that has closed goes on to the next stage. */
static void sweep(Group *c, State *s) {
    load_state(c, s);
    if (c->b->layered) kernel_at(c, c->on.a);
    evaluate(c, &c->on);
    V residual;
    I apart, done = closed(c, &c->on, &residual, &apart);
    int advances = 0;
    for (int l = 0; l < c->count; l++) {
        int64_t i = c->index[l];
        if (done[l]) s[i].residual = residual[l], s[i].edge_q = c->on.Kq[c->on.n][l], s[i].stage = AT_FINISH;
        if (done[l] ? apart[l] : c->last || !(residual[l] == residual[l])) s[i].rung = -1;
        advances |= !done[l] && s[i].rung >= 0;
    }
    if (!advances) return;
    V eta = c->on.eta + advance(c, &c->on), a = vexp(eta);
    for (int l = 0; l < c->count; l++) {
        int64_t i = c->index[l];
        if (done[l] || s[i].rung < 0) continue;
        s[i].count++, s[i].eta = eta[l], s[i].a = a[l];
        for (int64_t k = 0; k < c->on.n; k++) s[i].y[k] = c->on.y[k][l] + c->step[k][l];
    }
}
/* The part of the load that is tensile, of a smooth punch. */
static V tension(Group *c) {
    const Points *p = &c->mesh->between;
    V below = all(0);
    combine(c, p->basis, c->on.n, p->m, c->on.q, c->points);
    for (int64_t i = 0; i < p->m; i++) below += p->w[i] * most(-c->points[i], all(0.0));
    return below / size_of(against(p->w, c->points, p->m));
}
/* The state on the finer mesh after one step there; y, q and g before it; and P'/D' of the branch of solutions. */
static V refine(Group *c) {
    Equation *f = &c->fine;
    int64_t n = f->n;
    f->eta = c->on.eta, f->a = c->on.a;
    interpolate(c, &c->mesh->fine, c->b->layered ? c->table->J_fine : 0, 1e-8, f->y);
    evaluate(c, f);
    V d_eta = advance(c, f), of_P, of_D;
    V P = along(c, f, LOAD, c->d_eta, &of_P), D = along(c, f, DEPTH, c->d_eta, &of_D);
    for (int64_t i = 0; i < n; i++) {
        c->y_start[i] = f->y[i], c->q_start[i] = f->q[i], c->g_start[i] = f->g[i];
        f->y[i] += c->step[i], f->q[i] += f->dq[i] * c->step[i], f->g[i] += f->dg[i] * c->step[i];
    }
    f->Kq[n] = dot(c->K + n * n, f->q, n) + f->slope[n] * d_eta;
    f->eta += d_eta;
    f->a = vexp(f->eta);
    f->X = 8 / PI * c->law.p_star / (f->a * c->E);
    return (P + of_P) / (D + of_D);
}
/* The error of the profiles, over their largest: what the step on the finer mesh changes. */
static V of_profiles(const Group *c, V margin) {
    const Equation *f = &c->fine;
    V change = all(0), largest = all(0), other = all(0), most_area = all(0);
    for (int64_t i = 0; i < f->n; i++) {
        change = most(size_of(f->q[i] - c->q_start[i]), change);
        largest = most(f->q[i], largest);
        if (c->b->law == SMOOTH) continue;
        V new = area_of(&c->law, f->y[i], f->q[i]);
        other = most(size_of(new - area_of(&c->law, c->y_start[i], c->q_start[i])), other);
        most_area = most(new, most_area);
    }
    if (c->b->law == SMOOTH) other = size_of(against(c->mesh->at_edge, c->on.q, c->on.n)), most_area = largest;
    return margin * most(change / largest, other / most_area);
}
/* The profiles of the cases of a group that are `shown`. */
static void profiles(Group *c, I shown) {
    const Batch *b = c->b;
    const Points *p = &c->mesh->profile;
    interpolate(c, p, b->layered ? c->table->J_profile : 0, 1e-13, c->points);
    for (int64_t i = 0; i < p->m; i++) {
        V y = c->points[i], q = curve_of(&c->law, y).q * b->shrink[i], lam = area_of(&c->law, y, q);
        for (int l = 0; l < c->count; l++) {
            if (!shown[l]) continue;
            int64_t to = c->index[l] * b->columns + b->place[i];
            b->p[to] = c->law.p_star[l] * q[l];
            b->lam[to] = lam[l];
        }
    }
}
/* What becomes of a group of cases that have closed: each is solved, goes on to the finer mesh, or is handed back. */
static void finish(Group *c, State *s) {
    const Batch *b = c->b;
    int64_t n = c->on.n, rough = b->law != SMOOTH;
    load_state(c, s);
    if (b->layered) kernel_at(c, c->on.a);
    curves(c, &c->on);
    c->on.Kq[n] = OF_STATES(s, edge_q);
    Quantities coarse = quantities(c, &c->on);
    before_points(c);
    V slope = refine(c), change = all(0), probe = all(0);
    Quantities fine = quantities(c, &c->fine);
    for (int i = 0; i < JUDGED; i++) {
        V of = size_of(coarse.value[i] / fine.value[i] - 1);
        change = most(of, change);
        probe += of;
    }
    slope *= fine.value[P_] / fine.value[D_];
    V smallest = c->on.q[0], largest = smallest;
    for (int64_t i = 1; i < n; i++) smallest = least(c->on.q[i], smallest), largest = most(c->on.q[i], largest);
    V centre = c->on.q[n - 1], around = all(0);
    for (int64_t i = 0; i < c->fine.n; i++)
        if (c->fine.s[i] >= 0.9) around = most(size_of(c->fine.q[i] - c->q_start[i]), around);
    around /= centre;
    change = pick((around > most(change, all(1e-8))) & (smallest > 0), around, change);
    if (!rough) change = most(change, (b->control == RADIUS ? 3.0 : 1.0) * unseen(c, c->on.a, c->on.s[0]));
    V share = rough ? c->on.Z * c->on.g[0] / (c->on.s[0] * c->on.s[0]) : all(1.0);
    I blind = rough ? share < 0.5 : share != share;
    V margin = pick(blind, all(6.0), all(2.0)), floor = of_operator(c, c->on.a, n);
    if (b->layered) {
        V rounded = 3 * EPS * most((c->layer.n + c->layer.m) / (1 + c->layer.m), all(1.0)) * largest;
        floor = most(floor, rounded / most(size_of(centre), rounded));
    }
    V error = most(margin * change, floor), pulls = all(0);
    if (rough) {
        V moved = 2 * moved_edge(c);
        error = most(error, missed_ring(c));
        V both = pick(blind, 2 * least(error, moved), all(0.0));
        error = most(most(error, moved), both);
    } else pulls = tension(c);
    I bad = ~is_finite(probe + c->fine.eta + error) | (pulls > 1e-9) | (centre < 0), wanting = error > c->rtol;
    I fixed = all(0.0) != 0, judged;
    EACH(l) if (b->fixed[c->index[l]]) fixed[l] = -1;
    judged = ~bad & (~wanting | fixed);
    if (rough && any(judged)) error = pick(judged, completed(c, coarse.value[Ar_An_], error), error);
    wanting = (wanting | (error > c->rtol)) & ~fixed;
    V before = OF_STATES(s, before);
    I slow = error > 0.5 * before;
    bad |= ~is_finite(error) | (wanting & (floor > c->rtol) & (error <= pick(slow, 30 * floor, floor)));
    bad |= wanting & slow & (error > 100 * c->rtol) & (all(n) >= 48);
    for (int i = 0; i < 7; i++) bad |= ~is_finite(coarse.value[i]);
    I solved = ~bad & ~wanting;
    V profile = any(solved) ? most(error, of_profiles(c, margin)) : error;
    if (any(solved & fixed)) {                                        /* P'/D' of this mesh, as the other numbers */
        V of_P, of_D;
        evaluate(c, &c->on);
        advance(c, &c->on);
        V P = along(c, &c->on, LOAD, c->d_eta, &of_P), D = along(c, &c->on, DEPTH, c->d_eta, &of_D);
        slope = pick(fixed, coarse.value[P_] / coarse.value[D_] * ((P + of_P) / (D + of_D)), slope);
    }
    if (b->points && any(solved)) profiles(c, solved);
    for (int l = 0; l < c->count; l++) {
        int64_t k = c->index[l];
        if (bad[l]) s[k].rung = -1;
        else if (wanting[l]) {
            s[k].rung++, s[k].stage = AT_STEPS, s[k].before = error[l];
            s[k].eta = c->fine.eta[l], s[k].a = c->fine.a[l];
            for (int64_t i = 0; i < c->fine.n; i++) s[k].y[i] = c->fine.y[i][l];
        }
        if (bad[l] || wanting[l]) continue;
        double *to = b->scalars + k;
        for (int i = 0; i < 7; i++) to[i * b->stride] = coarse.value[i][l];
        to[dP_dD_ * b->stride] = slope[l], to[residual_ * b->stride] = s[k].residual;
        to[error_ * b->stride] = error[l], to[profile_error_ * b->stride] = profile[l];
        b->nodes[k] = (int32_t)n, b->iterations[k] = s[k].count, s[k].rung = -1;
    }
}
/* Radius, softness and first mesh of a group of cases. */
static void begin(Group *c, State *s) {
    const Batch *b = c->b;
    V a = c->value, soft = all(1.0), P = c->value, e = all(1.5), gamma = all(1.351283845031745);
    if (b->law == POWER_LAW || b->law == SMOOTH) e = 1 / c->law.beta, gamma = all(1.0);
    if (b->control == DEPTH) a = root(1.5 * P);
    if (b->control == LOAD) {
        V springs = 4 * c->C * P / PI, both = power(2 * c->law.A_star * gamma, e) * (2 * e + 2);
        V hertz = 0.75 * P / c->E, alone = P / (2 * PI * c->law.p_star) * both;
        V spots = b->law == SMOOTH ? all(0.0) : power(alone, 4 / (2 + 2 * e));
        for (int i = 0; i < 7; i++) {
            a = root(root(power(hertz * soft, all(4.0 / 3)) + springs + spots));
            if (!b->layered) break;
            if (i < 6) soft = softness(c, a);
        }
    }
    soft = softness(c, a);
    V X = 8 / PI * c->law.p_star / (a * c->E), Y = 2 * c->C * c->law.p_star / (a * a), Z = 2 * c->law.A_star / (a * a);
    V digits = all(1.1), factor = all(0.93), rise = all(0.0);
    if (b->law == SMOOTH) rise = 0.9 * clip(c->layer.h / a, all(0.0), all(1.0)), digits = all(2.3);
    else {
        V q = 1 / (X * soft * (PI * PI / 16) + Y + 1 / sparse_of(&c->law, 1 / Z));
        V share = Z * curve_of(&c->law, guess_of(&c->law, q)).g;
        rise = (b->law == POWER_LAW ? 0.5 : 1.1) * pick(share == share, clip(share, all(0.0), all(1.0)), all(0.0));
    }
    I springs = c->C > 0;
    if (!b->layered) digits = pick(springs, all(3.4), digits), factor = pick(springs, all(0.97), factor);
    V wanted = factor * (vlog(c->rtol) / -2.302585092994046 - digits + 3.6 * rise) / (0.25 + rise), eta = vlog(a);
    if (!b->layered) wanted = most(wanted, pick(springs & (c->rtol < 3e-5), all(8.0), all(0.0)));
    for (int l = 0; l < c->count; l++) {
        int64_t i = c->index[l], r = 0;
        while (b->fixed[i] ? b->ladder[r] != b->fixed[i] : b->ladder[r] < 32 && b->ladder[r] < wanted[l]) r++;
        s[i].rung = a[l] - a[l] == 0 && wanted[l] == wanted[l] ? r : -1;
        s[i].eta = eta[l], s[i].a = b->control == RADIUS ? vexp(eta)[l] : a[l], s[i].soft = soft[l];
        s[i].before = __builtin_inf();
    }
}
static void first_guess(Group *c, State *s) {
    V a = OF_STATES(s, a), soft = OF_STATES(s, soft);
    V X = 8 / PI * c->law.p_star / (a * c->E), Y = 2 * c->C * c->law.p_star / (a * a), Z = 2 * c->law.A_star / (a * a);
    for (int64_t i = 0; i < c->on.n; i++) {
        double at = c->on.s[i];
        V base = (X * soft * (PI * PI / 16) * at + Y) / (at * at);
        V more = c->b->law == SMOOTH ? all(0.0) : 1 / sparse_of(&c->law, at * at / Z);
        V y = guess_of(&c->law, 1 / (base + more));
        for (int l = 0; l < c->count; l++) s[c->index[l]].y[i] = y[l];
    }
    for (int l = 0; l < c->count; l++) s[c->index[l]].stage = AT_STEPS;
}

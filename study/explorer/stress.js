"use strict";
/* Stresses on the axis r = 0, and at the edge of the contact on the surface: docs/stresses.md. Depths are in a, stresses in
   the unit of the pressure, tension is positive. What stands behind each part in Python is named at it. */
const Stress = ((Core) => {
  /** Nodes of a panel of k, and the largest width of one. */
  const POINTS = 16, WIDEST = 12;
  /** Waves count by erfc((k - MIDDLE)/WIDTH)/2. In the pressure waves beyond are those of the edge of the contact, of which the
      axis feels exp(-(WIDTH/2)²): so thin layers need no more waves than thick ones (tests/explorer/test_stress.py). */
  const MIDDLE = 60, WIDTH = 12, LAST = 108;
  /** Nodes over the angle arcsin(s) that carry p^(k) up to LAST; solver/numerics. */
  const ANGLES = 128;
  /** Of the edge: 2kh at which waves have decayed to 1e-7, and the thinnest layer in a, for time. */
  const END = 16, THINNEST = 1 / 64;

  /* ---- the pressure as a sum of waves ---- */

  const panels = new Map();

  /** k, weights and J0(k cos(angle)) of the panel i: [2^(i - 1), 2^i] up to 8, then of the width 12. */
  function panel(i) {
    if (panels.has(i)) return panels.get(i);
    const rule = Core.gauss(POINTS), angles = Core.gauss(ANGLES), low = i > 3 ? 8 + (i - 4) * WIDEST : 2 ** (i - 1);
    const width = i > 3 ? WIDEST : low, k = rule.t.map((t) => low + width * t), J0 = new Float64Array(POINTS * ANGLES);
    const w = k.map((at, j) => width * rule.w[j] * at * (1 - erf((at - MIDDLE) / WIDTH)) / 2);
    for (let j = 0; j < POINTS; j++) for (let g = 0; g < ANGLES; g++) J0[j * ANGLES + g] = Core.j0(k[j] * Math.cos(Math.PI / 2 * angles.t[g]));
    const made = { k, w, J0 };
    panels.set(i, made);
    return made;
  }

  function erf(x) {
    const rule = Core.gauss(32);
    let sum = 0;
    for (let i = 0; i < 32; i++) sum += rule.w[i] * Math.exp(-((x * rule.t[i]) ** 2));
    return 2 / Math.sqrt(Math.PI) * x * sum;
  }

  /** The pressure at the nodes of an angle in [0, pi/2] with the weights of p^(k). */
  function weighted(p, count) {
    const angles = Core.gauss(count);
    return Float64Array.from(angles.t, (t, i) => {
      const angle = Math.PI / 2 * t, s = Math.sin(angle);
      return p(s) * s * Math.cos(angle) * Math.PI / 2 * angles.w[i];
    });
  }

  /** Nodes k from `least` on, and weights with the transform of the pressure: w p^(k) k. */
  function transformed(p, least) {
    const values = weighted(p, ANGLES), k = [], w = [];
    for (let i = Math.floor(Math.log2(least)); 8 + (i - 4) * WIDEST < LAST; i++) {
      const own = panel(i);
      for (let j = 0; j < POINTS; j++) {
        let sum = 0;
        for (let g = 0; g < ANGLES; g++) sum += own.J0[j * ANGLES + g] * values[g];
        k.push(own.k[j]);
        w.push(own.w[j] * sum);
      }
    }
    return { k: Float64Array.from(k), w: Float64Array.from(w) };
  }

  /* ---- waves of layer and body; solver/kernels/transfer.py. A state is [u, w, S, T] ---- */

  function decaying(x, nu, S, T) {
    const decay = Math.exp(-x), shift = x * (S - T);
    return [decay * ((1 - 2 * nu) * S - 2 * (1 - nu) * T - shift), decay * ((1 - 2 * nu) * T - 2 * (1 - nu) * S - shift),
      decay * (S + shift), decay * (T + shift)];
  }

  function growing(y, nu, S, T) {
    const [u, w, s, t] = decaying(y, nu, S, -T);
    return [u, -w, s, -t];
  }

  const minus = (one, other) => one.map((value, i) => value - other[i]);
  const slope = ([u, w, S, T], nu) => [w + 2 * T, ((1 - 2 * nu) * S - nu * u) / (1 - nu), -T, (u + nu * S) / (1 - nu)];

  /** x cosh x - sinh x, below 0.8 the sum of 2j x^(2j + 1)/(2j + 1)!. */
  function odd(x) {
    if (x >= 0.8) return x * Math.cosh(x) - Math.sinh(x);
    let term = x, total = 0;
    for (let j = 1; j <= 10; j++) total += 2 * j * (term *= x * x / (2 * j * (2 * j + 1)));
    return total;
  }

  /** v, A v, N v and A N v of a state v: with cosh x, sinh x, (x sinh x)/2 and (x cosh x - sinh x)/2 the state at the depth
      x below, for x below about 1.5. */
  function powers(nu, v) {
    const first = slope(v, nu), second = minus(slope(first, nu), v);
    return [v, first, second, slope(second, nu)];
  }
  function carried(x, [v, first, second, third]) {
    const cosh = Math.cosh(x), sinh = Math.sinh(x), half = x * sinh / 2, rest = odd(x) / 2;
    return v.map((value, i) => cosh * value + sinh * first[i] + half * second[i] + rest * third[i]);
  }

  function solved([a, c], [b, d], [e, f]) {
    const determinant = a * d - b * c;
    return [(e * d - b * f) / determinant, (a * f - e * c) / determinant];
  }

  /** What is 0 at the interface with the state above it. */
  function jumps({ alpha, nu2, bonded }, [u, w, S, T]) {
    const above = 1 / (1 + alpha), below = alpha / (1 + alpha), normal = 2 * (1 - nu2), cross = 1 - 2 * nu2;
    return [bonded ? above * u - below * (cross * S - normal * T) : T, above * w + below * (normal * S - (bonded ? cross * T : 0))];
  }

  /** The wave k: tractions S, T on the body; of a thin layer its `powers`; of a thick one tractions (down, up) of the waves
      that decay from the surface and from the interface. */
  function wave(b, k, h) {
    const X = k * h, nu = b.nu1;
    let made, under;
    if (X < 1) {
      const ends = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0]].map((v) => jumps(b, carried(X, powers(nu, v))));
      const own = powers(nu, [...solved(ends[0], ends[1], ends[2].map((v) => -v)), -1, 0]);
      made = { powers: own };
      under = carried(X, own);
    } else {
      const column = (S, T) => {
        const up = growing(X, nu, S, T);
        return jumps(b, minus(growing(0, nu, S, T), decaying(X, nu, up[2], up[3])));
      };
      const up = solved(column(1, 0), column(0, 1), jumps(b, decaying(X, nu, -1, 0)).map((v) => -v)), back = growing(X, nu, ...up);
      made = { down: [-1 - back[2], -back[3]], up };
      under = minus(growing(0, nu, ...up), decaying(X, nu, 1 + back[2], back[3]));
    }
    return { ...made, S: under[2], T: b.bonded ? under[3] : 0 };
  }

  /** u and S at the depth z in the layer, and at the depth z below tractions S, T on a body. */
  function inLayer(nu, k, h, own, z, out) {
    const x = k * z;
    if (own.powers) {
      const cosh = Math.cosh(x), sinh = Math.sinh(x), half = x * sinh / 2, rest = odd(x) / 2, [v, first, second, third] = own.powers;
      out[0] = cosh * v[0] + sinh * first[0] + half * second[0] + rest * third[0];
      out[1] = cosh * v[2] + sinh * first[2] + half * second[2] + rest * third[2];
      return;
    }
    below(nu, x, own.down[0], own.down[1], out);
    const y = k * h - x, [S, T] = own.up, decay = Math.exp(-y), shift = y * (S + T);
    out[0] += decay * ((1 - 2 * nu) * S + 2 * (1 - nu) * T - shift);
    out[1] += decay * (S + shift);
  }
  function below(nu, x, S, T, out) {
    const decay = Math.exp(-x), shift = x * (S - T);
    out[0] = decay * ((1 - 2 * nu) * S - 2 * (1 - nu) * T - shift);
    out[1] = decay * (S + shift);
  }

  const radialSum = (nu, u, S) => (2 * nu * S + (1 + nu) * u) / (1 - nu);

  /* ---- the field of a contact ---- */

  /** sr and sz on the axis: state(i, out) gives u and S of the wave i. */
  function summed(nu, { w }, state) {
    const out = new Float64Array(2);
    let sr = 0, sz = 0;
    for (let i = 0; i < w.length; i++) {
      state(i, out);
      sr += w[i] * radialSum(nu, out[0], out[1]) / 2;
      sz += w[i] * out[1];
    }
    return { sr, sz, mises: Math.abs(sr - sz) };
  }

  /** The field of the solved contact `ev`: {layer(z), body(z), punch(z, nu), edge()}, functions of the depth that give
      {sr, sz, mises}; `layer` is null without one, `body` of a rigid one. edge: sr on the surface at r = a, NaN of layers
      that are too thin for it. On the axis Tresca's stress is von Mises'. */
  function field(ev) {
    const { c } = ev, h = c.layered ? c.h / ev.a : 0, p = (s) => c.pStar * Core.pressure(ev, s), load = c.pStar * ev.load;
    const all = transformed(p, 1e-4 * Math.min(1, 1 / h) / Math.max(1, c.layered ? c.n : 1)), { k } = all;
    const bare = (z, nu) => summed(nu, all, (i, out) => below(nu, k[i] * z, -1, 0, out));
    if (!c.layered) return { h, layer: null, body: (z) => bare(z, c.nu2), punch: bare, edge: () => (1 - 2 * c.nu2) * load };
    const b = { alpha: c.n * (1 - c.nu1) / (1 - c.nu2), nu1: c.nu1, nu2: c.nu2, bonded: c.bonded }, waves = Array.from(k, (at) => wave(b, at, h));
    return {
      h, punch: bare,
      layer: (z) => summed(c.nu1, all, (i, out) => inLayer(c.nu1, k[i], h, waves[i], z, out)),
      body: c.n > 0 ? (z) => summed(c.nu2, all, (i, out) => below(c.nu2, k[i] * (z - h), waves[i].S, waves[i].T, out)) : null,
      edge: () => (h < THINNEST ? NaN : (1 - 2 * c.nu1) * load + edgeOf(b, p, h, c.n, ev.mesh.n)),
    };
  }

  /** By how much sr at the edge differs from that of a half-space of the layer: the sum over all waves. */
  function edgeOf(b, p, h, n, nodes) {
    const rule = Core.gauss(POINTS), values = {}, v = [0, 0], bare = [0, 0];
    let sum = 0, low = 0, high = 1e-4 * Math.min(1, 1 / h) / Math.max(1, n);
    while (low < END / (2 * h)) {
      for (let i = 0; i < POINTS; i++) {
        const k = low + (high - low) * rule.t[i], points = Core.anglesFor(k, nodes), angles = Core.gauss(points);
        values[points] ??= weighted(p, points);
        let transform = 0;
        for (let j = 0; j < points; j++) transform += values[points][j] * Core.j0(k * Math.cos(Math.PI / 2 * angles.t[j]));
        inLayer(b.nu1, k, h, wave(b, k, h), 0, v);
        below(b.nu1, 0, -1, 0, bare);
        const u = v[0] - bare[0], S = v[1] - bare[1], J0 = Core.j0(k);
        sum += (high - low) * rule.w[i] * transform * k * (radialSum(b.nu1, u, S) * J0 - u * (2 * Core.j1(k) / k - J0)) / 2;
      }
      [low, high] = [high, Math.min(2 * high, high + WIDEST)];
    }
    return sum;
  }

  /** The largest value of f(z) on a grid, made better by golden section between its neighbours: {z, value}. */
  function largest(f, zs) {
    const values = zs.map(f), i = values.indexOf(Math.max(...values)), part = (Math.sqrt(5) - 1) / 2;
    let low = zs[Math.max(0, i - 1)], high = zs[Math.min(zs.length - 1, i + 1)];
    let z = high - part * (high - low), other = low + part * (high - low), one = f(z), two = f(other);
    for (let step = 0; step < 12; step++) {
      if (one > two) [high, other, two, z, one] = [other, z, one, other - part * (other - low), NaN];
      else [low, z, one, other, two] = [z, other, two, z + part * (high - z), NaN];
      if (Number.isNaN(one)) one = f(z); else two = f(other);
    }
    const best = [[zs[i], values[i]], [z, one], [other, two]].reduce((a, b) => (b[1] > a[1] ? b : a));
    return { z: best[0], value: best[1] };
  }

  /** Depths from 0 to `end`, close together near the surface. */
  const depths = (end, count) => Array.from({ length: count + 1 }, (_, i) => end * (i / count) ** 2);

  /** The largest von Mises stress on the axis of the "layer", the "body" or the "punch": {z, value}. */
  function peak({ h, layer, body, punch }, which, nuPunch) {
    if (which === "layer") {
      const zs = h <= 3 ? Array.from({ length: 21 }, (_, i) => h * i / 20) : [...depths(3, 20), ...depths(h - 3, 8).slice(1).map((z) => 3 + z)];
      return largest((z) => layer(z).mises, zs);
    }
    return which === "body" ? largest((z) => body(z).mises, depths(3 + 2 * h, 24).map((z) => h + z)) : largest((z) => punch(z, nuPunch).mises, depths(3, 20));
  }

  /* ---- asperities; solver/yields/asperities.py ---- */

  /** The largest von Mises stress on the axis of the central spot, {z, value}: that of the spot less that of p on its cell, and
      that of the contact. */
  function spot(ev, own) {
    const { c } = ev, nu = c.layered ? c.nu1 : c.nu2, at = Core.profile(ev, 0), share = Math.sqrt(at.lam), rule = Core.gauss(20);
    const p0s = 2 * c.E * share / (Math.PI * Math.sqrt(Math.PI * c.Nbar) * c.Ra), ratio = at.p / p0s, b = share / Math.sqrt(Math.PI * c.Nbar) / ev.a;
    const whole = own.layer ? (z) => own.layer(Math.min(z, own.h)) : own.body;
    const of = (z) => {
      let E = 0, F = 0;
      for (let i = 0; i < 20; i++) {
        const angle = Math.asin(share) * rule.t[i], t = Math.sin(angle) / share;
        const part = (t * Math.cos(angle) / share + 2 / Math.PI * ratio * t) * Math.asin(share) * rule.w[i] * t / (z * z + t * t);
        E += part;
        F += part * 2 * z * z / (z * z + t * t);
      }
      const cos = z / Math.hypot(1 / share, z), { sr, sz } = whole(z * b);
      return Math.abs(p0s * ((1 - 2 * nu) / 2 * E + 1.5 * F - ratio * ((1 - 2 * nu) / 2 + (1 + nu) * cos - 1.5 * cos ** 3)) + sr - sz);
    };
    const found = largest(of, Array.from({ length: 9 }, (_, i) => 0.2 + 0.15 * i));
    return { z: found.z * b, value: found.value };
  }

  return { field, peak, spot, THINNEST };
})(typeof module === "undefined" ? Core : require("./core.js"));
if (typeof module !== "undefined") module.exports = Stress;

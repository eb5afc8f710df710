"use strict";
/* Stresses on the axis r = 0, and at the edge of the contact on the surface: docs/stresses.md. Depths are in a, stresses in
   the unit of the pressure, tension is positive. What stands behind each part in Python is named at it. */
const Stress = ((Core) => {
  /** Nodes of a panel of k, the largest width of one, and kh at which waves have decayed to 1e-7. */
  const POINTS = 16, WIDEST = 12, END = 16;
  /** Thinner layers, in a, take seconds: they are left to the program. */
  const THINNEST = 1 / 64;

  /* ---- a half-space, from its pressure ---- */

  /** sr and sz on the axis at depth z of a half-space under the pressure p(s): integrals over v = z/sqrt(r² + z²). */
  function halfSpace(p, nu, z) {
    if (!(z > 0)) return { sr: -(1 + 2 * nu) / 2 * p(1), sz: -p(1) };
    const rule = Core.gauss(24), first = z / Math.hypot(1, z);
    let whole = 0, steep = 0;
    for (let low = first; low < 1; low *= 2) {
      const high = Math.min(1, 2 * low);
      for (let i = 0; i < 24; i++) {
        const t = rule.t[i], edge = low === first, v = low + (high - low) * (edge ? t * t : t); // p ~ s at the edge
        const weight = (high - low) * rule.w[i] * (edge ? 2 * t : 1), value = p(Math.sqrt(Math.max(0, 1 - z * z * (1 / (v * v) - 1))));
        whole += weight * value;
        steep += 3 * weight * value * v * v;
      }
    }
    return { sr: (steep - 2 * (1 + nu) * whole) / 2, sz: -steep };
  }

  /* ---- waves of layer and body; solver/fields/transfer.py. A state is [u, w, S, T] ---- */

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

  /** The state at the depth x below one of state v, for x below about 1.5. */
  function carried(x, nu, v) {
    const first = slope(v, nu), second = minus(slope(first, nu), v), third = slope(second, nu);
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

  /** Of the wave k: a function of the depth z that gives the state less that of a half-space of the layer, and the
      tractions S, T on the body. */
  function wave(b, k, h) {
    const X = k * h, nu = b.nu1;
    let layer, below;
    if (X < 1) {
      const ends = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0]].map((v) => jumps(b, carried(X, nu, v)));
      const surface = [...solved(ends[0], ends[1], ends[2].map((v) => -v)), -1, 0];
      layer = (z) => minus(carried(k * z, nu, surface), decaying(k * z, nu, -1, 0));
      below = carried(X, nu, surface);
    } else {
      const column = (S, T) => {
        const up = growing(X, nu, S, T);
        return jumps(b, minus(growing(0, nu, S, T), decaying(X, nu, up[2], up[3])));
      };
      const up = solved(column(1, 0), column(0, 1), jumps(b, decaying(X, nu, -1, 0)).map((v) => -v)), back = growing(X, nu, ...up);
      layer = (z) => {
        const rising = growing(X - k * z, nu, ...up);
        return decaying(k * z, nu, -back[2], -back[3]).map((value, i) => value + rising[i]);
      };
      below = minus(growing(0, nu, ...up), decaying(X, nu, 1 + back[2], back[3]));
    }
    return { layer, S: below[2], T: b.bonded ? below[3] : 0 };
  }

  const radialSum = (nu, [u, , S]) => (2 * nu * S + (1 + nu) * u) / (1 - nu);

  /* ---- the field of a contact ---- */

  /** Nodes k, and weights with the transform of the pressure: w p^(k) k. */
  function transformed(p, nodes, h, n) {
    const rule = Core.gauss(POINTS), last = END / h, k = [], w = [], values = {};
    let low = 0, high = 1e-4 * Math.min(1, 1 / h) / Math.max(1, n);
    while (low < last) {
      for (let i = 0; i < POINTS; i++) { k.push(low + (high - low) * rule.t[i]); w.push((high - low) * rule.w[i]); }
      [low, high] = [high, Math.min(2 * high, high + WIDEST)];
    }
    k.forEach((at, i) => {
      const points = 32 * Math.ceil((0.42 * at + 3 * Math.cbrt(at) + 2 * nodes) / 32), angles = Core.gauss(points);
      values[points] ??= Float64Array.from(angles.t, (t, j) => {
        const angle = Math.PI / 2 * t, s = Math.sin(angle);
        return p(s) * s * Math.cos(angle) * Math.PI / 2 * angles.w[j];
      });
      let sum = 0;
      for (let j = 0; j < points; j++) sum += values[points][j] * Core.j0(at * Math.cos(Math.PI / 2 * angles.t[j]));
      w[i] *= sum * at;
    });
    return { k, w };
  }

  /** The field of the solved contact `ev`: {p, layer(z), body(z), edge}, functions of the depth that give {sr, sz, mises};
      `layer` is null without one, `body` of a rigid one; edge: sr on the surface at r = a. Null of thinner layers. */
  function field(ev) {
    const { c, mesh } = ev, h = c.h / ev.a, p = (s) => c.pStar * Core.pressure(ev, s);
    const whole = (at) => ({ ...at, mises: Math.abs(at.sr - at.sz) }), load = c.pStar * ev.load;
    if (!c.layered) return { p, layer: null, body: (z) => whole(halfSpace(p, c.nu2, z)), edge: (1 - 2 * c.nu2) * load };
    if (h < THINNEST) return null;
    const b = { alpha: c.n * (1 - c.nu1) / (1 - c.nu2), nu1: c.nu1, nu2: c.nu2, bonded: c.bonded };
    const { k, w } = transformed(p, mesh.n, h, c.n), waves = k.map((at) => wave(b, at, h));
    let more = 0;
    waves.forEach((own, i) => {
      const v = own.layer(0), J0 = Core.j0(k[i]);
      more += w[i] * (radialSum(c.nu1, v) * J0 - v[0] * (2 * Core.j1(k[i]) / k[i] - J0)) / 2;
    });
    const layer = (z) => {
      const at = halfSpace(p, c.nu1, z);
      waves.forEach((own, i) => {
        const v = own.layer(z);
        at.sr += w[i] * radialSum(c.nu1, v) / 2;
        at.sz += w[i] * v[2];
      });
      return whole(at);
    };
    const body = (z) => {
      const at = { sr: 0, sz: 0 };
      waves.forEach((own, i) => {
        const v = decaying(k[i] * (z - h), c.nu2, own.S, own.T);
        at.sr += w[i] * radialSum(c.nu2, v) / 2;
        at.sz += w[i] * v[2];
      });
      return whole(at);
    };
    return { p, layer, body: c.n > 0 ? body : null, edge: (1 - 2 * c.nu1) * load + more };
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

  /** The largest von Mises stresses on the axis: {layer, body, punch}, each {z, value} or null. */
  function peaks(ev, own, nuPunch) {
    const h = ev.c.layered ? ev.c.h / ev.a : 0, punch = ev.c.m > 0;
    const inLayer = h <= 3 ? Array.from({ length: 21 }, (_, i) => h * i / 20) : [...depths(3, 20), ...depths(h - 3, 8).slice(1).map((z) => 3 + z)];
    return {
      layer: own.layer && largest((z) => own.layer(z).mises, inLayer),
      body: own.body && largest((z) => own.body(z).mises, depths(3 + 2 * h, 24).map((z) => h + z)),
      punch: punch ? largest((z) => { const at = halfSpace(own.p, nuPunch, z); return Math.abs(at.sr - at.sz); }, depths(3, 20)) : null,
    };
  }

  return { field, peaks, THINNEST };
})(typeof module === "undefined" ? Core : require("./core.js"));
if (typeof module !== "undefined") module.exports = Stress;

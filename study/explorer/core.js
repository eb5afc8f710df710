"use strict";
/* The solver of the page, in units R = E2* = 1 (rigid base: E1* = 1). It solves the equation of docs/model.md as solver/
   does, on meshes of 16 and 22 nodes that Python made; their difference is the error. What stands behind each part in
   Python is named at it. */
const Core = (() => {
  const COARSE = 16, FINE = 22, meshes = {}, rules = {}, tables = new Map();

  /* ---- numbers: quadrature, J0 and J1, linear equations ---- */

  /** Gauss-Legendre rule with n points on [0, 1]. */
  function gauss(n) {
    if (rules[n]) return rules[n];
    const t = new Float64Array(n), w = new Float64Array(n);
    for (let i = 0; 2 * i < n; i++) { // the others are their mirror images
      let x = Math.cos(Math.PI * (i + 0.75) / (n + 0.5)), slope = 1;
      for (let step = 0; step < 100; step++) {
        let before = 1, now = x;
        for (let k = 2; k <= n; k++) {
          const next = ((2 * k - 1) * x * now - (k - 1) * before) / k;
          before = now;
          now = next;
        }
        slope = n * (x * now - before) / (x * x - 1);
        x -= now / slope;
        if (Math.abs(now / slope) < 1e-15) break;
      }
      t[i] = (1 - x) / 2;
      t[n - 1 - i] = (1 + x) / 2;
      w[i] = w[n - 1 - i] = 1 / ((1 - x * x) * slope * slope);
    }
    return (rules[n] = { t, w });
  }

  /* a_k of Hankel's expansion of J_m for large x, without its signs of m = 0: (4 m² - 1)(4 m² - 9).../(k! 8^k). */
  const HANKEL = [0, 1].map((m) => {
    const a = new Float64Array(24).fill(1);
    for (let k = 1; k < 24; k++) a[k] = a[k - 1] * ((2 * k - 1) ** 2 - 4 * m * m) / (8 * k);
    return a;
  });

  const SQUARES = Float64Array.from({ length: 60 }, (_, k) => 1 / (k * k || 1));
  const PRODUCTS = Float64Array.from({ length: 60 }, (_, k) => 1 / (k * (k + 1) || 1));

  /** J_m(x), x >= 0, m = 0 or 1, to 1e-11: below 12 by its series, whose largest term is 4e3 there, beyond by Hankel's
      expansion. */
  function bessel(m, x) {
    if (x < 12) {
      const z = -x * x / 4, less = m ? PRODUCTS : SQUARES;
      let term = m ? x / 2 : 1, sum = term;
      for (let k = 1; term > 1e-13 || term < -1e-13; k++) sum += (term *= z * less[k]);
      return sum;
    }
    const less = 1 / x, a = HANKEL[m];
    let P = 0, Q = 0, power = 1, sign = 1;
    for (let k = 0; k < 24; k += 2, sign = -sign) {
      const term = a[k] * power, next = a[k + 1] * (power *= less);
      P += sign * term;
      Q -= sign * next;
      if (Math.abs(term) < 1e-12) break;
      power *= less;
    }
    const angle = x - (2 * m + 1) * Math.PI / 4;
    return Math.sqrt(2 / (Math.PI * x)) * (P * Math.cos(angle) - Q * Math.sin(angle));
  }
  const j0 = (x) => bessel(0, x), j1 = (x) => bessel(1, x);

  /** Lagrange polynomials of `nodes` at one point; solver/numerics/quadrature.py. */
  function lagrange(nodes, weights, point, out) {
    let sum = 0;
    for (let j = 0; j < nodes.length; j++) {
      if (point === nodes[j]) { out.fill(0); out[j] = 1; return out; }
      sum += (out[j] = weights[j] / (point - nodes[j]));
    }
    for (let j = 0; j < nodes.length; j++) out[j] /= sum;
    return out;
  }

  function barycentric(nodes) {
    return Float64Array.from(nodes, (own) => 1 / nodes.reduce((all, other) => all * (other === own ? 1 : 4 * (own - other)), 1));
  }

  /** LU with pivoting of A (n x n, rows one after another), which is overwritten. */
  function factorise(A, n) {
    const order = Int32Array.from({ length: n }, (_, i) => i);
    for (let c = 0; c < n; c++) {
      let best = c;
      for (let r = c + 1; r < n; r++) if (Math.abs(A[r * n + c]) > Math.abs(A[best * n + c])) best = r;
      if (best !== c) {
        for (let j = 0; j < n; j++) [A[c * n + j], A[best * n + j]] = [A[best * n + j], A[c * n + j]];
        [order[c], order[best]] = [order[best], order[c]];
      }
      for (let r = c + 1; r < n; r++) {
        const f = (A[r * n + c] /= A[c * n + c]);
        for (let j = c + 1; j < n; j++) A[r * n + j] -= f * A[c * n + j];
      }
    }
    return (b) => {
      const x = new Float64Array(n);
      for (let r = 0; r < n; r++) {
        x[r] = b[order[r]];
        for (let j = 0; j < r; j++) x[r] -= A[r * n + j] * x[j];
      }
      for (let r = n - 1; r >= 0; r--) {
        for (let j = r + 1; j < n; j++) x[r] -= A[r * n + j] * x[j];
        x[r] /= A[r * n + r];
      }
      return x;
    };
  }

  const dot = (a, b) => { let sum = 0; for (let i = 0; i < a.length; i++) sum += a[i] * b[i]; return sum; };

  /* ---- the layer: kernel, quadrature, operator ---- */

  function nested(z, divisors) {
    let total = 1;
    for (let i = divisors.length - 1; i >= 0; i--) total = 1 + z / divisors[i] * total;
    return total;
  }
  const GAP = [30, 56, 90, 132, 182, 240, 306, 380], EXCESS = [20, 42, 72, 110, 156, 210, 272, 342];

  /** L(u) - 1 and u dL/du of model `c` at u into `out`; solver/kernels/closed_form.py. */
  function kernel(c, u, out) {
    u = Math.max(u, 1e-300);
    const e = Math.exp(-2 * u), rest = -Math.expm1(-2 * u), z = 4 * u * u, small = u < 0.8;
    const gap = small ? e * z * z / 12 * nested(z, GAP) : rest * rest - 4 * u * u * e;
    const excess = small ? e * u * z / 3 * nested(z, EXCESS) : rest * (1 + e) / 2 - 2 * u * e;
    if (!c.bonded) {
      const below = rest * (1 + e) + 4 * u * e + c.n * gap, share = 4 * e / below, more = c.n - 1;
      const L1 = share * (more * (rest / 2 + u) + c.n * u * u);
      const slope = 4 * e * (1 + e) - 8 * u * e + 2 * c.n * (2 * excess - gap);
      out[0] = L1;
      out[1] = u * (share * (more * (1 + e) + 2 * c.n * u) - L1 * (2 + slope / below));
      return;
    }
    const { c1, c2, less1, less2 } = c;
    let below, slope;
    if (c2 > 0) {
      below = less1 * less2 + less1 * c2 * (rest - z * e) + c1 * less2 * rest + c1 * c2 * gap;
      slope = 2 * e * (less1 * c2 * (1 - 4 * u + z) + c1 * less2) + c1 * c2 * (4 * excess - 2 * gap);
    } else {
      below = (c1 > 0 ? less1 + c1 * rest : 1 - c1 * e) * (1 - c2 * e) - c2 * z * e;
      slope = e * (2 * (c1 + c2 + c2 * z) - 8 * c2 * u - 4 * c1 * c2 * e);
    }
    const above = e * (4 * c2 * u * (1 + u) + (c.n - 1) * less1 * less2 + 2 * c1 * c2 * rest);
    out[0] = above / below;
    out[1] = u * (e * (4 * c2 * (1 + 2 * u) + 4 * c1 * c2 * e) - 2 * above - out[0] * slope) / below;
  }

  /** The kernel of layer and punch together, over that of a half-space of both. */
  function softness(c, a) {
    if (!c.layered) return 1;
    const out = [0, 0];
    kernel(c, 1.5 * c.h / a, out);
    return 1 + out[0] / (1 + c.m);
  }

  const FIRST = -8, LAST = 40, STIFFEST = [2, 1e3, 1e6, 1e9], DEPTH = [0, 12, 22, 32];

  /** Nodes k and weights for an octave of h/a and a class of stiffness, as in solver/body/wave_rule.py with fewer points:
      they leave some 1e-7 of the results, less than the meshes do. */
  function waves(octave, stiff) {
    const scale = 2 ** -octave, cut = 9, ends = [0], k = [], w = [];
    for (let d = DEPTH[stiff]; d >= 0; d--) ends.push(0.5 * 2 ** -d);
    ends.push(1, 2, 4, cut);
    for (let i = 0; i + 1 < ends.length; i++) {
      const low = ends[i], high = ends[i + 1], pieces = Math.ceil((high - low) * scale / 200);
      const width = (high - low) * scale / pieces;
      const order = Math.max(high >= 0.5 ? 9 : 5, Math.floor(width / 2 + 2 * Math.cbrt(width)) + 4);
      const decayed = 2 * (low - Math.log1p(low)) / Math.LN10;
      const rule = gauss(Math.max(4, order - Math.floor(0.8 * decayed)));
      for (let piece = 0; piece < pieces; piece++) {
        for (let j = 0; j < rule.t.length; j++) {
          k.push(low * scale + (piece + rule.t[j]) * width);
          w.push(width * rule.w[j]);
        }
      }
    }
    return { k: Float64Array.from(k), w: Float64Array.from(w) };
  }

  /** The few nodes k (M) whose L - 1 give w (L - 1) at all G nodes, as rows of `spread` (M x G): `few` of the same file.
      They are chosen by random layers of the class and octave, to 1e-9 of the largest. */
  function few(octave, stiff, { k, w }) {
    const G = k.length, size = 60, rest = [], out = [0, 0], low = Math.log(stiff ? STIFFEST[stiff - 1] : 1e-9), high = Math.log(STIFFEST[stiff]);
    let seed = 1;
    const random = () => { // mulberry32: the same nodes everywhere
      let t = (seed = (seed + 0x6d2b79f5) | 0);
      t = Math.imul(t ^ (t >>> 15), t | 1);
      t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
      return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
    };
    const end = () => 1.1 * Math.sin(Math.PI / 2 * random()) ** 2 - 0.05; // most at the ends, some beyond
    for (let i = 0; i < size; i++) {
      const n = stiff === 0 && random() < 0.5 ? 2 * random() : Math.exp(low + (high - low) * end());
      const c = model({ layered: true, n, m: 0, nu1: random() / 2, nu2: random() / 2, bonded: random() < 0.67 }), h = 2 ** (octave + end());
      const L1 = new Float64Array(G), uL = new Float64Array(G);
      let whole = 0;
      for (let g = 0; g < G; g++) {
        kernel(c, k[g] * h, out);
        L1[g] = out[0] * w[g] / (1 + k[g] * k[g]);
        uL[g] = out[1] * w[g] / (1 + k[g] * k[g]);
        whole += Math.abs(L1[g]);
      }
      for (const row of [L1, uL]) rest.push(row.map((v) => v / Math.max(whole, 1)));
    }
    const nodes = [], rows = [], left = new Float64Array(G);
    for (const row of rest) for (let g = 0; g < G; g++) left[g] += row[g] * row[g];
    const most = Math.max(...left);
    while (nodes.length < 80) {
      const next = left.indexOf(Math.max(...left));
      if (left[next] < 1e-18 * most) break;
      nodes.push(next);
      const length = Math.sqrt(left[next]), direction = rest.map((row) => row[next] / length), sum = new Float64Array(G);
      rest.forEach((row, i) => { for (let g = 0; g < G; g++) sum[g] += direction[i] * row[g]; });
      rows.push(sum);
      left.fill(0);
      rest.forEach((row, i) => { for (let g = 0; g < G; g++) { row[g] -= direction[i] * sum[g]; left[g] += row[g] * row[g]; } });
      for (const node of nodes) left[node] = 0;
    }
    for (let r = nodes.length - 1; r >= 0; r--) { // back substitution of the triangle rows[:, nodes]
      const pivot = rows[r][nodes[r]];
      for (let g = 0; g < G; g++) rows[r][g] /= pivot;
      for (let above = 0; above < r; above++) {
        const f = rows[above][nodes[r]];
        for (let g = 0; g < G; g++) rows[above][g] -= f * rows[r][g];
      }
    }
    const scale = (g) => w[g] / (1 + k[g] * k[g]);
    return { k: nodes.map((node) => k[node]), spread: rows.map((row, r) => row.map((v, g) => v * scale(nodes[r]) * (1 + k[g] * k[g]) * Math.PI / 2)) };
  }

  /** What makes the operator from L - 1 at few nodes: for each of these a matrix, and under it the row of the edge. */
  function table(mesh, octave, stiff) {
    const key = `${mesh.n} ${octave} ${stiff}`;
    if (tables.has(key)) return tables.get(key);
    const all = waves(octave, stiff), shared = `few ${octave} ${stiff}`, n = mesh.n, k = all.k, G = k.length;
    if (!tables.has(shared)) tables.set(shared, { ...few(octave, stiff, all), fine: transforms(meshes[FINE], k) });
    const own = tables.get(shared), phi = of(mesh, own, k), size = (n + 1) * n, products = own.k.map(() => new Float64Array(size));
    const edge = k.map(j0), row = new Float64Array(G), both = new Float64Array(G);
    for (let i = 0; i <= n; i++) {
      for (let g = 0; g < G; g++) row[g] = i < n ? j0(k[g] * mesh.x[i]) - edge[g] : edge[g];
      for (let j = 0; j < n; j++) {
        for (let g = 0; g < G; g++) both[g] = row[g] * phi[j * G + g];
        for (let f = 0; f < own.k.length; f++) products[f][i * n + j] = dot(own.spread[f], both);
      }
    }
    const made = { ...own, products, phi, all: k };
    tables.set(key, made);
    return made;
  }

  /** Transforms (n x G) of the polynomials of a mesh from those of the finest, of whose polynomials they are sums. */
  function of(mesh, { fine }, k) {
    if (mesh.n === FINE) return fine;
    const G = k.length, phi = new Float64Array(mesh.n * G), values = new Float64Array(mesh.n);
    meshes[FINE].s.forEach((s, i) => {
      lagrange(mesh.s, mesh.weights, s, values);
      for (let j = 0; j < mesh.n; j++) for (let g = 0; g < G; g++) phi[j * G + g] += values[j] * fine[i * G + g];
    });
    return phi;
  }

  /** How many points over the angle carry the transform of a polynomial of n nodes at k: few numbers, for time. */
  function anglesFor(k, n) {
    const least = 0.42 * k + 3 * Math.cbrt(k) + 2 * n, step = least > 256 ? 128 : 32;
    return step * Math.ceil(least / step);
  }

  /** Transforms of the Lagrange polynomials (n x G) at k: over the angle, s = sin(angle), the phase is k cos(angle). */
  function transforms(mesh, k) {
    const n = mesh.n, G = k.length, phi = new Float64Array(n * G), basis = {};
    for (let g = 0; g < G; g++) {
      const points = anglesFor(k[g], n);
      if (!basis[points]) {
        const rule = gauss(points), B = new Float64Array(points * n), out = new Float64Array(n), cos = new Float64Array(points);
        for (let i = 0; i < points; i++) {
          const angle = Math.PI / 2 * rule.t[i], s = Math.sin(angle);
          cos[i] = Math.cos(angle);
          lagrange(mesh.s, mesh.weights, s, out);
          for (let j = 0; j < n; j++) B[i * n + j] = out[j] * s * cos[i] * Math.PI / 2 * rule.w[i];
        }
        basis[points] = { B, cos };
      }
      const { B, cos } = basis[points], sums = new Float64Array(n);
      for (let i = 0; i < points; i++) {
        const value = j0(k[g] * cos[i]);
        for (let j = 0; j < n; j++) sums[j] += value * B[i * n + j];
      }
      for (let j = 0; j < n; j++) phi[j * G + g] = sums[j];
    }
    return phi;
  }

  /** The operator of model `c` at radius a on a mesh: `rows`, the matrix K and under it the row of the edge, and `slopes`,
      its derivative by ln a. */
  function operator(c, a, mesh) {
    const n = mesh.n, tab = c.layered ? tableOf(c, a, mesh) : null, M = tab ? tab.k.length : 0, size = (n + 1) * n;
    const rows = new Float64Array(size), uL = new Float64Array(M), out = [0, 0];
    rows.set(mesh.K);
    rows.set(mesh.edge, n * n);
    for (let f = 0; f < M; f++) {
      kernel(c, tab.k[f] * c.h / a, out);
      const L1 = out[0] / (1 + c.m), own = tab.products[f];
      uL[f] = -out[1] / (1 + c.m);
      for (let i = 0; i < size; i++) rows[i] += L1 * own[i];
    }
    const times = (matrix, q) => {
      const to = new Float64Array(n + 1);
      for (let i = 0; i <= n; i++) for (let j = 0; j < n; j++) to[i] += matrix[i * n + j] * q[j];
      return to;
    };
    return {
      tab, rows,
      products: (q) => times(rows, q),
      slopes(q) {
        const matrix = new Float64Array(size);
        for (let f = 0; f < M; f++) for (let i = 0, own = tab.products[f]; i < size; i++) matrix[i] += uL[f] * own[i];
        return times(matrix, q);
      },
    };
  }

  function tableOf(c, a, mesh) {
    const octave = Math.min(LAST, Math.max(FIRST, Math.floor(Math.log2(c.h / a)) || 0));
    const stiff = STIFFEST.findIndex((most) => c.n <= most);
    return table(mesh, octave, stiff < 0 ? 3 : stiff);
  }

  /* ---- asperities: the disc cell; solver/laws/disc_cell.py ---- */

  function curve(c, y) {
    if (!c.rough) return { q: y, g: 0, dq: 1, dg: 0, lam: 1 };
    const sin2 = 1 / (1 + y * y), sin = Math.sqrt(sin2), cos = y * sin, theta = Math.atan(1 / y), sc = sin * cos;
    const cos2 = cos * cos, slope = cos2 / (theta + sc), q = slope * cos;
    const z = 4 * theta * theta;
    const less = theta < 0.3 ? theta * z / 6 * (1 - z / 20 * (1 - z / 42 * (1 - z / 72 * (1 - z / 110)))) : theta - sc;
    const dqs = slope / (theta + sc) * ((cos2 - 3 * sin2) * less - 6 * sin2 * sc);
    const dq = sin2 * slope * (3 * sin + 2 * q), dg = sin2 * (2 * sc + 4 / 3 * dqs);
    return { q, g: cos2 - 4 / 3 * q * sin, dq, dg, lam: cos2 };
  }

  const peak = (c, y, q) => (c.rough ? 3 / Math.PI / Math.sqrt(1 + y ** -2) + 2 / Math.PI * q * Math.atan(y) : q);

  /** y with q(y) = q within 1 %. */
  function guessed(c, q) {
    if (!c.rough) return q;
    const m = 2 / 3 * q, kappa = Math.PI / 4 * q;
    const t = Math.cbrt(m ** 3 + kappa + Math.sqrt(kappa) * Math.sqrt(2 * m ** 3 + kappa));
    return Math.max(m + t + m * m / t, 2 * q);
  }

  const sparse = (c, g) => (c.rough ? (g / (Math.PI / 2) ** (2 / 3)) ** 1.5 : Infinity);

  /* ---- the contact; solver/rough ---- */

  /** A model from parameters as in docs/model.md: control ("P", "a", "D"), value, layered, h, n, m, nu1, nu2, bonded,
      rough, Nbar, Ra. */
  function model(p) {
    const c = { ...p, E1: p.layered ? p.n || 1 : 1 };
    c.E = c.E1 / (1 + c.m);
    const cell = 1 / Math.sqrt(Math.PI * c.Nbar);
    c.pStar = c.rough ? 2 * c.E * cell / (3 * c.Ra) : c.E;
    c.AStar = c.rough ? cell * cell / c.Ra : 0;
    if (c.layered && c.bonded) {
      const alpha = c.n * (1 - c.nu1) / (1 - c.nu2), g1 = 3 - 4 * c.nu1, g2 = 3 - 4 * c.nu2;
      const excess = ((c.n - 1) * (1 - c.nu1) + (c.nu2 - c.nu1)) / (1 - c.nu2);
      c.c1 = (excess * g2 + 4 * (c.nu1 - c.nu2)) / (1 + alpha * g2);
      c.c2 = excess / (alpha + g1);
      c.less1 = (1 + g1) / (1 + alpha * g2);
      c.less2 = (1 + g1) / (alpha + g1);
    }
    return c;
  }

  /** The equation of model c at y (n) and eta = ln a: residual F at the nodes and G of the control. */
  function evaluate(c, y, eta, mesh) {
    const n = mesh.n, a = Math.exp(eta), op = operator(c, a, mesh);
    const q = new Float64Array(n), g = new Float64Array(n), dq = new Float64Array(n), dg = new Float64Array(n);
    const F = new Float64Array(n), lam = new Float64Array(n), X = 8 / Math.PI * c.pStar / (a * c.E), Z = 2 * c.AStar / (a * a);
    for (let i = 0; i < n; i++) {
      const at = curve(c, y[i]);
      q[i] = at.q; g[i] = at.g; dq[i] = at.dq; dg[i] = at.dg; lam[i] = at.lam;
    }
    const Kq = op.products(q), edge = Kq[n], load = dot(mesh.w, q);
    let residual = 0;
    for (let i = 0; i < n; i++) {
      F[i] = X * Kq[i] + Z * g[i] - mesh.s[i] * mesh.s[i];
      residual = Math.max(residual, Math.abs(F[i]));
    }
    const depth = 1 + X * edge, value = c.value;
    const G = c.control === "a" ? eta - Math.log(value)
      : c.control === "P" ? Math.log(2 * Math.PI * c.pStar * load / value) + 2 * eta
      : Math.log(depth / (2 * value)) + 2 * eta;
    residual = Math.max(residual, Math.abs(G)) || NaN;
    return { c, y, eta, a, mesh, op, q, g, dq, dg, lam, X, Z, Kq, edge, load, depth, F, G,
      residual: Number.isNaN(G) ? Infinity : residual };
  }

  /** The right-hand side -dF/d eta over X, at fixed q. */
  function turn(ev) {
    ev.slope = ev.op.slopes(ev.q);
    return ev.F.map((_, i) => -(ev.slope[i] - ev.Kq[i] - 2 * ev.Z * ev.g[i] / ev.X));
  }

  const ownOf = (ev) => ev.F.map((_, i) => ev.Z * ev.dg[i] / ev.dq[i] / ev.X);

  /** Solves with K + diag: dF/dq over X. */
  function matrix(ev) {
    const n = ev.mesh.n, rows = ev.op.rows, own = ownOf(ev), A = rows.slice(0, n * n);
    for (let i = 0; i < n; i++) A[i * n + i] += own[i];
    ev.edgeRow = rows.slice(n * n);
    return factorise(A, n);
  }

  /** The derivative of the logarithm of a control along (dq, 1 in eta). */
  function along(ev, control, dq, edge, dEta) {
    if (control === "a") return dEta;
    if (control === "P") return dot(ev.mesh.w, dq) / ev.load + 2 * dEta;
    return (ev.X * edge + (ev.X * ev.slope[ev.mesh.n] - ev.X * ev.edge) * dEta) / ev.depth + 2 * dEta;
  }

  function step(ev) {
    const solve = matrix(ev), t = solve(turn(ev)), d = solve(ev.F.map((f) => -f / ev.X)), control = ev.c.control;
    const move = -(ev.G + along(ev, control, d, dot(ev.edgeRow, d), 0)) / along(ev, control, t, dot(ev.edgeRow, t), 1);
    const dEta = Math.min(1, Math.max(-1, move));
    const y = ev.y.map((old, i) => {
      const next = old + (d[i] + t[i] * dEta) / ev.dq[i];
      return ev.c.rough ? Math.min(5 * old, Math.max(0.2 * old, next)) : next;
    });
    return evaluate(ev.c, y, ev.eta + dEta, ev.mesh);
  }

  /** Newton's method; null where it does not close. */
  function newton(ev, most = 40) {
    for (let count = 0; count < most; count++) {
      if (!Number.isFinite(ev.residual)) return null;
      if (ev.residual < Math.max(1e-12, 4e-15 / softness(ev.c, ev.a))) return ev;
      const next = step(ev);
      if (ev.residual < 1e-9 && !(next.residual < ev.residual / 2)) return ev; // only rounding is left
      ev = next;
    }
    return null;
  }

  function guessRadius(c) {
    if (c.control === "a") return c.value;
    if (c.control === "D") return Math.sqrt(1.5 * c.value);
    const e = 1.5, gamma = (Math.PI / 2) ** (2 / 3);
    const spots = (c.value / (2 * Math.PI * c.pStar) * (2 * c.AStar * gamma) ** e * (2 * e + 2)) ** (1 / (2 + 2 * e));
    let a = Infinity, soft = 1;
    for (let i = 0; i < 7; i++) {
      a = (Math.cbrt(0.75 * c.value / c.E * soft) ** 4 + spots ** 4) ** 0.25;
      soft = softness(c, a);
    }
    return a;
  }

  const HERTZ = Math.PI ** 2 / 16;

  function firstGuess(c, mesh) {
    const a = guessRadius(c), X = 8 / Math.PI * c.pStar / (a * c.E), Z = 2 * c.AStar / (a * a), soft = softness(c, a);
    return evaluate(c, mesh.s.map((s) => guessed(c, 1 / (X * soft * HERTZ / s + 1 / sparse(c, s * s / Z)))), Math.log(a), mesh);
  }

  /** The contact of a given radius, from the smooth one; null where Newton's method fails. */
  function atRadius(c, eta, mesh) {
    const fixed = { ...c, control: "a", value: Math.exp(eta) }, n = mesh.n, begin = evaluate(fixed, mesh.s, eta, mesh);
    const smooth = factorise(begin.op.rows.slice(0, n * n), n)(mesh.s.map((s) => s * s / begin.X));
    const least = 1e-12 * Math.max(...smooth);
    const y = smooth.map((q, i) => guessed(c, 1 / (1 / Math.max(q, least) + 1 / sparse(c, mesh.s[i] ** 2 / begin.Z))));
    const found = newton(evaluate(fixed, y, eta, mesh));
    return found && evaluate(c, found.y, eta, mesh);
  }

  /** A search for the radius where Newton's method fails, by false position; solver/rough/newton.py. */
  function byRadius(c, mesh) {
    let low = null, high = null, eta = Math.log(guessRadius(c));
    for (let count = 0; count < 60; count++) {
      const ev = atRadius(c, eta, mesh);
      if (!ev) return null;
      if (Math.abs(ev.G) < 1e-10) return ev;
      const end = { eta, G: ev.G };
      if (ev.G < 0) { if (high && low) high.G /= 2; low = end; } else { if (high && low) low.G /= 2; high = end; }
      eta = low && high ? low.eta + (high.eta - low.eta) * low.G / (low.G - high.G) : eta + (ev.G < 0 ? 0.5 : -0.5);
    }
    return null;
  }

  function quantities(ev) {
    const { c, a, mesh, q } = ev, n = mesh.n;
    return {
      a,
      P: 2 * Math.PI * a * a * c.pStar * ev.load,
      D: a * a / 2 * ev.depth,
      p0: c.pStar * q[n - 1],
      p_max: c.pStar * peak(c, ev.y[n - 1], q[n - 1]),
      Ar_An: c.rough ? 2 * dot(mesh.w, ev.lam) : 1,
      A0: c.AStar * ev.g[n - 1],
      lam0: ev.lam[n - 1],
    };
  }

  function stiffness(ev, t, edge, Q) {
    return Q.P * along(ev, "P", t, edge, 1) / (Q.D * along(ev, "D", t, edge, 1));
  }

  /** q through the nodes and 0 at the edge: y at a point s; y is nearly proportional to s at the edge. */
  function between(ev, s) {
    const nodes = ev.mesh.ends;
    return dot(lagrange(nodes, ev.mesh.endWeights, s, new Float64Array(nodes.length)).subarray(1), ev.y);
  }

  /** Nominal pressure over p* at s. */
  const pressure = (ev, s) => (s > 0 ? curve(ev.c, between(ev, s)).q : 0);

  /** Nominal pressure p, λ and the largest real pressure at x = r/a. */
  function profile(ev, x) {
    const s = Math.sqrt((1 - x) * (1 + x)), y = between(ev, s), c = ev.c;
    if (!(s > 0) || (c.rough && !(y > 0))) return { p: 0, lam: 0, p_max: 0 };
    const at = curve(c, y);
    return { p: c.pStar * at.q, lam: at.lam, p_max: c.pStar * peak(c, y, at.q) };
  }

  /** Displacement of the surfaces of both bodies together, and of the punch alone, over R, at each of the radii `xs` = r/a.
      Inside the half-space's part is a polynomial in s; outside the kernel of its integral is smooth, and steep at the edge. */
  function displacements(ev, xs) {
    const { c, mesh, q, op } = ev, n = mesh.n, rule = gauss(48), inside = new Float64Array(n), out = [0, 0], scale = ev.a * ev.a / 2 * ev.X;
    for (let i = 0; i < n; i++) inside[i] = dot(mesh.K.subarray(i * n, (i + 1) * n), q) + dot(mesh.edge, q);
    const s = rule.t.map((t) => t * t), load = s.map((at, i) => 2 * rule.w[i] * rule.t[i] * at * curve(c, between(ev, at)).q);
    const k = op.tab ? op.tab.all : [], G = k.length, weight = new Float64Array(G), first = new Float64Array(n);
    for (let f = 0; f < (op.tab ? op.tab.k.length : 0); f++) {
      kernel(c, op.tab.k[f] * c.h / ev.a, out);
      for (let g = 0; g < G; g++) weight[g] += out[0] / (1 + c.m) * op.tab.spread[f][g];
    }
    for (let g = 0; g < G; g++) {
      let t = 0;
      for (let j = 0; j < n; j++) t += op.tab.phi[j * G + g] * q[j];
      weight[g] *= t;
    }
    return xs.map((x) => {
      let H = 0, layer = 0;
      if (x <= 1) H = dot(lagrange(mesh.s, mesh.weights, Math.sqrt((1 - x) * (1 + x)), first), inside);
      for (let i = 0; x > 1 && i < 48; i++) {
        let one = 1, other = Math.sqrt((x * x - 1 + s[i] * s[i]) / (x * x));
        while (Math.abs(one - other) > 1e-9) [one, other] = [(one + other) / 2, Math.sqrt(one * other)];
        H += load[i] * Math.PI / (2 * one * x);
      }
      for (let g = 0; g < G; g++) layer += weight[g] * j0(k[g] * x);
      return { both: scale * (H + layer), punch: scale * H * c.m / (1 + c.m) };
    });
  }

  /** One mesh. `before`: a solution on another mesh, where Newton's method begins. */
  function onMesh(c, n, before) {
    const mesh = meshes[n];
    const begin = before ? evaluate(c, mesh.s.map((s) => between(before, s)), before.eta, mesh) : firstGuess(c, mesh);
    const ev = newton(begin) || byRadius(c, mesh);
    if (!ev) return null;
    ev.solve = matrix(ev);
    ev.t = ev.solve(turn(ev));
    ev.Q = quantities(ev);
    ev.Q.dP_dD = stiffness(ev, ev.t, dot(ev.edgeRow, ev.t), ev.Q);
    return ev;
  }

  const JUDGED = ["a", "P", "D", "p0", "p_max", "Ar_An", "dP_dD"];

  /** The contact with parameters p: {status, Q, error, ev}. status "converged", "lift_off", "film" (h < a/256), or
      "open". error: the largest relative difference of the results on 16 and on 22 nodes; NaN with `quick`, which
      solves on 16 nodes alone. */
  function solve(p, quick) {
    const c = model(p), coarse = onMesh(c, COARSE), ev = quick ? coarse : onMesh(c, FINE, coarse);
    if (!ev) return { status: "open" };
    if (c.layered && c.h < 2 ** FIRST * ev.a) return { status: "film", a: ev.a };
    const error = quick || !coarse ? NaN : Math.max(...JUDGED.map((name) => Math.abs(coarse.Q[name] / ev.Q[name] - 1)));
    if (!c.rough && tension(ev) > Math.max(1e-9, 10 * (error || 1e-4))) return { status: "lift_off" };
    return { status: ev.Q.p0 > 0 ? "converged" : "lift_off", Q: ev.Q, error, ev, c };
  }

  /** The tensile part of the load, of smooth contacts. */
  function tension(ev) {
    const rule = gauss(64);
    let pull = 0;
    for (let i = 0; i < 64; i++) pull += Math.max(-between(ev, rule.t[i]), 0) * rule.w[i] * rule.t[i];
    return pull / Math.abs(ev.load);
  }

  /** d ln Q by a number that changes the parameters from `minus` to `plus` when it grows by 2 d; solver/sensitivity. The
      equation at the same state gives the change of the state with the factorised matrix of the solution. */
  function sensitivity(ev, plus, minus, d) {
    const models = [model(plus), model(minus)], n = ev.mesh.n, control = ev.c.control;
    const half = (f) => { const [one, other] = models.map(f); return one.map((v, i) => (v - other[i]) / (2 * d)); };
    const fixed = half((c) => { const at = evaluate(c, ev.y, ev.eta, ev.mesh); return [...at.F, at.G]; });
    const dq = ev.solve(Float64Array.from({ length: n }, (_, i) => -fixed[i] / ev.X));
    const slope = along(ev, control, ev.t, dot(ev.edgeRow, ev.t), 1);
    const dEta = -(fixed[n] + along(ev, control, dq, dot(ev.edgeRow, dq), 0)) / slope;
    const moved = models.map((c, i) => {
      const by = i ? -d : d;
      return evaluate(c, ev.y.map((y, j) => y + by * (dq[j] + ev.t[j] * dEta) / ev.dq[j]), ev.eta + by * dEta, ev.mesh);
    });
    // the tangent solves (K + diag) t = turn: its derivative comes from the same matrix
    const sides = moved.map((at) => {
      const right = turn(at), own = ownOf(at);
      at.Kt = at.op.products(ev.t);
      return right.map((v, i) => v - at.Kt[i] - own[i] * ev.t[i]);
    });
    const dt = ev.solve(sides[0].map((v, i) => (v - sides[1][i]) / (2 * d)));
    const logs = moved.map((at, i) => {
      const by = i ? -d : d, Q = quantities(at), t = ev.t.map((v, j) => v + by * dt[j]);
      Q.dP_dD = stiffness(at, t, at.Kt[n] + by * dot(ev.edgeRow, dt), Q);
      return JUDGED.map((name) => Math.log(Q[name]));
    });
    return Object.fromEntries(JUDGED.map((name, i) => [name, (logs[0][i] - logs[1][i]) / (2 * d)]));
  }

  /** Take the meshes that Python made: n -> base64 of s, x, w, edge (n) and K (n, n), float64, little endian. */
  function load(data) {
    for (const [key, text] of Object.entries(data)) {
      const n = Number(key), bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
      const all = new Float64Array(bytes.buffer), part = (i) => all.slice(i * n, (i + 1) * n);
      const mesh = { n, s: part(0), x: part(1), w: part(2), edge: part(3), K: all.slice(4 * n) };
      mesh.ends = Float64Array.from([0, ...mesh.s]);
      mesh.weights = barycentric(mesh.s);
      mesh.endWeights = barycentric(mesh.ends);
      meshes[n] = mesh;
    }
  }

  return { load, solve, sensitivity, profile, pressure, displacements, kernel, model, gauss, anglesFor, j0, j1 };
})();
if (typeof module !== "undefined") module.exports = Core;

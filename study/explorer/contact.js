"use strict";
/* One contact: from texts with units to the parameters of the solver, and from its numbers to texts. The names are those
   of `roughcoat point`. DATA, which page.py writes, has meshes, materials, limits and sentences of the Python program. */
const Contact = ((Core, Numbers, DATA) => {
  const { UNITS, short, percent, written, readable } = Numbers;
  Core.load(DATA.meshes);
  const MATERIALS = Object.fromEntries(DATA.materials.map((own) => [own.name, own]));

  /* ---- inputs and results ---- */

  /** Inputs that are numbers: SI unit, words, those of the form under the name of the body, and the range of the slider. */
  const INPUTS = {
    R: { unit: "m", label: "radius of the ball R", short: "radius R", range: [1e-6, 1] },
    E_punch: { unit: "Pa", label: "Young's modulus of the ball", short: "Young's modulus E", range: [1e4, 1.2e12] },
    nu_punch: { unit: "1", label: "Poisson ratio of the ball", short: "Poisson ratio ν", range: [0, 0.5] },
    E1: { unit: "Pa", label: "Young's modulus of the layer E1", short: "Young's modulus E1", range: [1e4, 1.2e12] },
    nu1: { unit: "1", label: "Poisson ratio of the layer ν1", short: "Poisson ratio ν1", range: [0, 0.5] },
    h: { unit: "m", label: "thickness of the layer h", short: "thickness h", range: [1e-9, 1e-1] },
    E2: { unit: "Pa", label: "Young's modulus of the body E2", short: "Young's modulus E2", range: [1e4, 1.2e12] },
    nu2: { unit: "1", label: "Poisson ratio of the body ν2", short: "Poisson ratio ν2", range: [0, 0.5] },
    P: { unit: "N", label: "load P", short: "load P", range: [1e-6, 1e5] },
    a: { unit: "m", label: "contact radius a", short: "contact radius a", range: [1e-8, 1e-1] },
    D: { unit: "m", label: "depth D", short: "depth D", range: [1e-10, 1e-2] },
    Nbar: { unit: "1/m^2", label: "asperities per area N̄", short: "asperities per area N̄", range: [1e4, 1e14] },
    Ra: { unit: "m", label: "radius of an asperity Ra", short: "radius of each Ra", range: [1e-8, 1e-2] },
  };
  /** Inputs that may be left out: yield strengths, of one's own materials. */
  const STRENGTHS = {
    Y_punch: { unit: "Pa", label: "yield strength of the ball", short: "yield strength Y", body: "punch" },
    Y1: { unit: "Pa", label: "yield strength of the layer Y1", short: "yield strength Y1", body: "layer" },
    Y2: { unit: "Pa", label: "yield strength of the body Y2", short: "yield strength Y2", body: "body" },
  };
  /** Inputs that are words, and those which the page has. */
  const CHOICES = { base: ["layered", "half_space"], bonding: ["bonded", "frictionless"], micro: ["smooth", "disc_cell"] };
  const RESULTS = {
    P: { unit: "N", label: "load", symbol: "P" },
    a: { unit: "m", label: "radius of the nominal contact area", symbol: "a" },
    D: { unit: "m", label: "indentation depth", symbol: "D" },
    p0: { unit: "Pa", label: "nominal pressure in the centre", symbol: "p(0)" },
    p_max: { unit: "Pa", label: "real pressure in the middle of the central spot", symbol: "pmax" },
    Ar_An: { unit: "1", label: "real over nominal contact area", symbol: "Ar/An" },
    dP_dD: { unit: "N/m", label: "contact stiffness", symbol: "dP/dD" },
  };
  const CONTROLS = ["P", "a", "D"], BODIES = { punch: ["E_punch", "nu_punch"], layer: ["E1", "nu1"], body: ["E2", "nu2"] };
  const START = { R: "5 mm", punch: "steel 52100", layer: "DLC a-C:H", h: "2 um", bonding: "bonded", body: "steel 52100",
    P: "10 N", micro: "smooth" };

  /** {value, spread, word, size} in SI of the text of an input; an Error with a message. */
  const parse = (name, text) => Numbers.parse(name, (INPUTS[name] || STRENGTHS[name]).unit, text);

  /* ---- from texts to a case ---- */

  const reduced = (E, nu) => E / (1 - nu * nu);

  /** Numbers {name: {value, spread}} of the texts, `strengths` in Pa, and {name: message} of what is wrong. */
  function read(texts) {
    const v = {}, problems = {}, strengths = {};
    const take = (name) => {
      try { v[name] = parse(name, texts[name] ?? ""); } catch (error) { problems[name] = error.message; }
    };
    for (const [body, [modulus, ratio]] of Object.entries(BODIES)) {
      const own = texts[body];
      if (body === "layer" && texts.base === "half_space") continue;
      if (own === "rigid" && body !== "layer") v[modulus] = { value: Infinity, spread: 0 };
      else if (own && MATERIALS[own]) {
        v[modulus] = { value: MATERIALS[own].E, spread: MATERIALS[own].E_spread };
        v[ratio] = { value: MATERIALS[own].nu, spread: MATERIALS[own].nu_spread };
      } else if (own) problems[body] = `${body}: "${own}" is not a material of the table`;
      else { take(modulus); take(ratio); }
    }
    for (const [name, words] of Object.entries(CHOICES)) {
      if (texts[name] !== undefined && !words.includes(texts[name])) problems[name] = `${name} = "${texts[name]}": this page has ${words.join(" and ")}`;
    }
    for (const [name, { body }] of Object.entries(STRENGTHS)) {
      if (texts[body] || !String(texts[name] ?? "").trim() || (body === "layer" && texts.base === "half_space")) continue;
      try { strengths[name] = parse(name, texts[name]).value; } catch (error) { problems[name] = error.message; }
      if (!(strengths[name] > 0)) problems[name] ??= `${name} = "${texts[name]}": must be above 0`;
    }
    v.nu_punch ??= { value: 0.3, spread: 0 };
    v.nu2 ??= { value: 0.3, spread: 0 };
    const layered = texts.base !== "half_space";
    for (const name of ["R", ...(layered ? ["h"] : []), ...(texts.micro === "disc_cell" ? ["Nbar", "Ra"] : [])]) take(name);
    const controls = CONTROLS.filter((name) => texts[name] !== undefined);
    if (controls.length === 1) take(controls[0]);
    else problems.P = "give one of P, a and D";
    for (const [name, number] of Object.entries(v)) {
      const isRatio = name.startsWith("nu");
      if (isRatio ? !(number.value > -1 && number.value <= 0.5) : !(number.value > 0)) {
        problems[name] = `${name} = "${texts[name] ?? number.value}": must be ${isRatio ? "above -1 and at most 0.5" : "above 0"}`;
      }
    }
    if (texts.body === "rigid" && !layered) problems.body = "body: a rigid body without a layer does not yield";
    return { v, strengths, problems, layered, control: controls[0] };
  }

  /** Parameters of the solver in units R = E2* = 1, and these units, of the SI numbers of `read`. */
  function scaled({ v, layered, control }, texts) {
    const E2 = reduced(v.E2.value, v.nu2.value), E1 = layered ? reduced(v.E1.value, v.nu1.value) : E2, R = v.R.value;
    const unit = Number.isFinite(E2) ? E2 : E1, rough = texts.micro === "disc_cell";
    const units = { P: unit * R * R, a: R, D: R, p0: unit, p_max: unit, Ar_An: 1, dP_dD: unit * R };
    const p = { control, value: v[control].value / units[control], layered, rough, bonded: texts.bonding === "bonded",
      h: layered ? v.h.value / R : 1, n: !layered ? 1 : Number.isFinite(E2) ? E1 / E2 : 0,
      m: E1 / reduced(v.E_punch.value, v.nu_punch.value), nu1: layered ? v.nu1.value : 0.3, nu2: v.nu2.value,
      Nbar: rough ? v.Nbar.value * R * R : 1, Ra: rough ? v.Ra.value / R : 1 };
    return { p, units, unit, R, E1, E2 };
  }

  /** Messages {name: text} for numbers beyond the bounds of the solver. */
  function beyondBounds(case_) {
    const { p, units } = case_, values = { [p.control]: p.value, m: p.m };
    if (p.layered) Object.assign(values, { h: p.h, n: p.n || 1 });
    if (p.rough) Object.assign(values, { Nbar: p.Nbar, Ra: p.Ra });
    const found = {};
    for (const [name, value] of Object.entries(values)) {
      const [low, high] = DATA.bounds[name];
      if (!(value >= low && value <= high)) {
        const place = { n: "E1", m: "E_punch" }[name] || name;
        found[place] = `${place} is beyond the bounds of the solver: ${name} = ${short(value, 3)}, allowed ${low} to ${high} (docs/model.md, units R and E2*)`;
      }
    }
    return found;
  }

  /** Whether the asperities are farther apart than the layer is thick: they then press on the body through it, which this
      page does not compute. As `far_apart` of solver/problem.py. */
  const feelLayer = (p) => p.layered && p.rough && p.Nbar * p.h ** 2 < 1 - 1e-9;

  /* ---- solving ---- */

  /** The contact of the texts: {texts, problems} or {status} or with results in SI: Q, spreads, digits, error, limits of
      Hertz, ring, lights. With `quick` 16 nodes serve and nothing is added but `beyond`, whether an assumption fails. */
  function solve(texts, quick) {
    const inputs = read(texts), problems = inputs.problems;
    if (Object.keys(problems).length) return { texts, problems, status: "invalid" };
    const case_ = scaled(inputs, texts);
    Object.assign(problems, beyondBounds(case_));
    if (Object.keys(problems).length) return { texts, problems, status: "invalid" };
    if (feelLayer(case_.p)) return { texts, inputs, case_, problems, status: "apart" };
    const solved = Core.solve(case_.p, quick);
    const contact = { texts, inputs, case_, problems, status: solved.status, ev: solved.ev, a: solved.a };
    if (solved.status !== "converged") return contact;
    contact.Q = Object.fromEntries(Object.entries(case_.units).map(([name, unit]) => [name, solved.Q[name] * unit]));
    contact.Q[inputs.control] = inputs.v[inputs.control].value;
    contact.lam0 = solved.Q.lam0;
    contact.ring = ring(contact);
    contact.lights = lights(contact, solved.Q);
    if (quick) return contact;
    // twice what the meshes differ by; the quadrature of the layer and J0 leave 1e-6 at most (tests/explorer)
    contact.error = Math.max(1e-6, 2 * solved.error);
    contact.digits = Math.max(1, Math.min(4, Math.floor(-Math.log10(2 * contact.error))));
    contact.sensitivities = sensitivities(contact);
    contact.spread = {};
    for (const name of Object.keys(RESULTS)) {
      const parts = Object.values(contact.sensitivities).map((own) => own[name] * own.relative);
      const relative = Math.hypot(...parts);
      contact.spread[name] = relative > 1e-5 ? contact.Q[name] * relative : 0; // as study.summary
    }
    contact.limits = limits(contact);
    return contact;
  }

  /** Input -> {a, P, ...: d ln Q/d ln input (d ln Q/d nu of a Poisson ratio), relative: its spread in the same measure}. */
  function sensitivities({ inputs, case_, texts, ev }) {
    const found = {}, d = 1e-4;
    for (const [name, number] of Object.entries(inputs.v)) {
      const ratio = name.startsWith("nu");
      if (!Number.isFinite(number.value) || (name === "nu_punch" && case_.p.m === 0) || (name === "nu2" && case_.p.n === 0)) continue;
      const [plus, minus] = [d, -d].map((by) => {
        const value = ratio ? number.value + by : number.value * (1 + by);
        return scaled({ ...inputs, v: { ...inputs.v, [name]: { ...number, value } } }, texts);
      });
      const own = Core.sensitivity(ev, plus.p, minus.p, d);
      for (const key of Object.keys(RESULTS)) own[key] += Math.log(plus.units[key] / minus.units[key]) / (2 * d);
      found[name] = { ...own, relative: ratio ? number.spread : number.spread / number.value };
    }
    return found;
  }

  /** Hertz's smooth contacts under the same control: [{name, Q}] of the layer alone and of the body alone. */
  function limits({ inputs, case_, Q }) {
    const E3 = reduced(inputs.v.E_punch.value, inputs.v.nu_punch.value), R = case_.R, control = inputs.control;
    const rows = case_.p.layered ? [["layer alone", case_.E1], ["body alone", case_.E2]] : [["smooth (Hertz)", case_.E2]];
    return rows.map(([name, modulus]) => {
      const E = 1 / (1 / modulus + 1 / E3);
      if (!Number.isFinite(E)) return { name, Q: null };
      const a = control === "a" ? Q.a : control === "D" ? Math.sqrt(Q.D * R) : Math.cbrt(0.75 * Q.P * R / E);
      return { name, Q: { a, P: 4 / 3 * E * a ** 3 / R, D: a * a / R, p0: 2 * E * a / (Math.PI * R), p_max: null, Ar_An: null, dP_dD: 2 * E * a } };
    });
  }

  /** The largest pressures over 33 points of the radius, as `point` takes them, if they are in a ring; or null. */
  function ring({ ev, case_, Q }) {
    let best = { p: 0 };
    let real = 0;
    for (let i = 0; i <= 32; i++) {
      const at = Core.profile(ev, i / 32);
      if (at.p > best.p) best = { ...at, x: i / 32 };
      real = Math.max(real, at.p_max);
    }
    const p = best.p * case_.unit;
    return p > DATA.limits.RING * Q.p0 ? { p, r: best.x * Q.a, p_peak: real * case_.unit } : null;
  }

  /* ---- validity ---- */

  const interpolated = (rows, at) => {
    const last = rows.length - 1, i = Math.max(1, rows.findIndex((row) => row[0] >= at));
    const [[x0, y0], [x1, y1]] = at >= rows[last][0] ? [rows[last - 1], rows[last]] : [rows[i - 1], rows[i]];
    return y0 + (y1 - y0) * Math.min(1, Math.max(0, (at - x0) / (x1 - x0)));
  };

  /** One row for each assumption that is looked at: {name, state "good" | "near" | "beyond", size: words}. The masks are
      those of study/rules/assumptions.py; near: beyond half of a limit. `q`: results without units. */
  function lights({ inputs, case_, ring }, q) {
    const { p, unit } = case_, L = DATA.limits, E1 = p.layered ? p.n || 1 : 1, rows = [];
    const light = (name, title, ratio, size) => rows.push({ name, title, size, state: ratio > 1 ? "beyond" : ratio > 0.5 ? "near" : "good" });
    light("strain_not_small", "Small against the ball", q.a / L.STEEP,
      `a/R = ${short(q.a)}, limit ${L.STEEP}. At the edge the ball is ${percent(q.a * q.a / 4)} deeper than the paraboloid that stands for it.`);
    if (p.layered) {
      const given = Math.min(q.D / p.h, q.p0 / E1), pulled = E1 * Math.min(p.h, q.a) * q.a ** 2 / 8 / q.p0;
      light("strain_not_small", "Layer hardly compressed", given / L.COMPRESSED,
        `It is compressed by about ${percent(given)}, limit ${percent(L.COMPRESSED)}: linear elasticity errs by about as much.`);
      light("strain_not_small", "Layer hardly stretched", pulled / L.STRETCHED,
        `As a membrane it bears about ${percent(pulled)} of the pressure, limit ${percent(L.STRETCHED)}; the model leaves that out.`);
    }
    if (p.rough) {
      const b = Math.sqrt(q.lam0 / (Math.PI * p.Nbar)), spots = p.Nbar * Math.PI * q.a ** 2, Ec = E1 / (1 + p.m);
      const steep = Math.max(b / p.Ra, Math.PI / 2 * (q.p_max - q.p0) / Ec);
      light("few_spots", "Many spots", L.FEW_SPOTS / spots,
        `${Numbers.count(spots)} asperities touch, at least ${L.FEW_SPOTS} are wanted: the model is an average, from which single contacts differ.`);
      light("spots_merging", "Spots apart", q.lam0 / L.MERGING,
        `λ(0) = ${short(q.lam0)}, limit ${L.MERGING}: what the asperities yield is about ${percent(interpolated(DATA.merging, q.lam0))} above that of a square lattice.`);
      light("asperity_strain_not_small", "Asperities hardly strained", steep / L.STEEP_SPOT,
        `b/Ra = ${short(steep)}, limit ${L.STEEP_SPOT}: a strain of about ${percent(0.2 * steep)} under an asperity.`);
    }
    const real = ring ? ring.p_peak : q.p_max * unit, nominal = ring ? ring.p : q.p0 * unit;
    const under = !p.layered ? real : q.a > p.h ? nominal : 0, pressed = { punch: real, layer: p.layered ? real : 0, body: under };
    const shares = Object.entries(BODIES).map(([body, [modulus]]) => {
      const E = inputs.v[modulus]?.value;
      return { body, share: E >= L.STIFF && Number.isFinite(E) ? pressed[body] / E : 0 };
    }).sort((one, two) => two.share - one.share);
    if (shares[0].share > 0) {
      light("metals_yield", "Below what metals bear", shares[0].share / L.YIELD,
        `The pressure on the ${shares[0].body === "punch" ? "ball" : shares[0].body} comes to ${percent(shares[0].share)} of its Young's modulus, limit ${percent(L.YIELD)}: metals yield before that.`);
    }
    return rows;
  }

  /* ---- words, and the same contact elsewhere ---- */

  const pretty = (text) => plain(text).replace(/\bu(?=m|N)/g, "µ");
  const bodyWords = (texts, body) => texts[body] || `a material with E = ${pretty(texts[BODIES[body][0]])}`;

  /** What was found, in sentences. */
  function words(contact) {
    const { texts, Q, inputs, case_ } = contact, show = (name) => shown(contact, name).whole, rough = case_.p.rough;
    const under = case_.p.layered ? `${pretty(texts.h)} of ${bodyWords(texts, "layer")}, ${texts.bonding === "bonded" ? "bonded to" : "sliding on"} ${bodyWords(texts, "body")}` : bodyWords(texts, "body");
    const ball = texts.punch === "rigid" ? "A rigid ball" : `A ball of ${bodyWords(texts, "punch")}`;
    const found = [`${ball}, R = ${pretty(texts.R)}${rough ? ", with asperities," : ""} is pressed with ${show("P")} on ${under}.`,
      `They touch on a circle of radius ${show("a")}; the bodies approach by ${show("D")}. The nominal pressure in the centre is ${show("p0")}.`];
    if (rough) found.push(`The asperities really touch on a share ${show("Ar_An")} of that circle; in the central spot the pressure is ${show("p_max")}.`);
    if (contact.ring) found.push(`The layer bends like a plate: the largest nominal pressure, ${readable(contact.ring.p, "Pa", contact.digits)}, is in a ring at r = ${readable(contact.ring.r, "m", contact.digits)}.`);
    found.push(`Its stiffness dP/dD is ${show("dP_dD")}.`);
    found.push("Whether it holds is said below, by the stresses on the axis. Not checked on this page: adhesion, friction, and stresses beside the axis.");
    return found;
  }

  /** A result with its ± and no more digits than its error allows. */
  function shown(contact, name) {
    const given = name === contact.inputs.control, own = written(contact.Q[name], RESULTS[name].unit, given ? 4 : contact.digits, contact.spread[name]);
    return given && !contact.spread[name] ? { ...own, whole: `${Number(own.text)} ${own.unit}` } : own;
  }

  const ORDER = ["R", "punch", "E_punch", "nu_punch", "Y_punch", "layer", "E1", "nu1", "Y1", "h", "bonding", "body", "E2", "nu2", "Y2", "P", "a", "D", "base", "micro", "Nbar", "Ra"];
  const plain = (text) => String(text).trim().replace(/[µμ]/g, "u").replace(/²/g, "^2").replace(/−/g, "-");
  const isWord = (name, text) => !(INPUTS[name] || STRENGTHS[name]) || /[^\d.eE+-]/.test(text);

  /** The texts that the contact uses, in order: what `point`, `solve` and a study file take. */
  function used(texts) {
    const left = new Set();
    for (const [body, own] of Object.entries(BODIES)) if (texts[body]) own.forEach((name) => left.add(name));
    if (texts.base === "half_space") ["layer", "E1", "nu1", "Y1", "h", "bonding"].forEach((name) => left.add(name));
    for (const [name, { body }] of Object.entries(STRENGTHS)) if (texts[body] || !String(texts[name] ?? "").trim()) left.add(name);
    if (texts.micro === "smooth") ["Nbar", "Ra"].forEach((name) => left.add(name));
    return ORDER.filter((name) => texts[name] !== undefined && !left.has(name)).map((name) => [name, plain(texts[name])]);
  }

  const shell = (text) => (/^[\w.,:/+-]+$/.test(text) ? text : `"${text.replace(/(["$`\\])/g, "\\$1")}"`);
  const quoted = (name, text) => (isWord(name, text) ? JSON.stringify(text) : text);
  const called = (texts) => `import roughcoat as rc\n\ncontact = rc.solve(\n${used(texts).map(([name, text]) => `    ${name}=${quoted(name, text)},`).join("\n")}\n)\n`;
  const COPIES = {
    command: (texts) => `roughcoat point ${used(texts).map(([name, text]) => `${name}=${shell(text)}`).join(" ")}`,
    python: (texts) => `${called(texts)}print(rc.summary(contact))\n`,
    stresses: (texts) => `${called(texts)}print(rc.extremes(contact, mu=0.1))  # the largest stresses anywhere, sliding with a friction of 0.1\nrc.plot_stresses(contact).savefig("stresses.png")\n`,
    toml: (texts) => `title = "A contact of the explorer"\n\n[model]\n${used(texts).map(([name, text]) => `${name} = ${quoted(name, text)}`).join("\n")}\n`,
  };

  const toHash = (texts) => `#${used(texts).map(([name, text]) => `${name}=${encodeURIComponent(text)}`).join("&")}`;

  /** The texts of a hash; what it does not name is as at the start. */
  function fromHash(hash) {
    const given = Object.fromEntries(new URLSearchParams(hash.replace(/^#/, "").replace(/\+/g, "%2B")));
    const known = Object.entries(given).filter(([name]) => ORDER.includes(name));
    return known.length ? { bonding: "bonded", micro: "smooth", ...Object.fromEntries(known) } : { ...START };
  }

  return { solve, read, shown, words, readable, written, parse, percent, toHash, fromHash, used, COPIES, INPUTS, STRENGTHS, CHOICES, RESULTS,
    CONTROLS, BODIES, MATERIALS, UNITS };
})(...(typeof module === "undefined" ? [Core, Numbers, DATA] : [require("./core.js"), require("./numbers.js"), globalThis.DATA]));
if (typeof module !== "undefined") module.exports = Contact;

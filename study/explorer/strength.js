"use strict";
/* Whether the bodies of a contact bear its stresses on the axis, and from which loads not: solver/yields. */
const Strength = ((Core, Stress, Contact, DATA) => {
  /** The parts of a contact that may yield, and the input that is the strength of one's own material. */
  const INPUTS = { punch: "Y_punch", layer: "Y1", body: "Y2", asperities: "" };
  /** Radii of the search grow by this. A strength is met to SAME of a stress. */
  const STEP = 1.5, SAME = 1e-4, NARROWEST = 1e-8;
  /** Nothing yields where (a/R) E over the strength is below these; asperities: times sqrt(Ra/R); solver/yields/first.py. */
  const NEVER = 0.3, NO_SPOT = 0.7;

  /** Strengths in Pa of punch, layer, body and asperities; NaN: not known. Asperities have that of the softer surface, of
      named materials; study/data/body_strengths.py. */
  function strengths({ texts, inputs, case_ }) {
    const named = (body) => Contact.MATERIALS[texts[body]]?.Y ?? NaN, own = (body) => inputs.strengths[INPUTS[body]] ?? named(body);
    const below = named(case_.p.layered ? "layer" : "body"), hard = case_.p.m === 0;
    const softer = hard || below <= named("punch") ? below : named("punch");
    return { punch: own("punch"), layer: own("layer"), body: own("body"), asperities: Number.isNaN(below) ? NaN : softer };
  }

  /** The largest von Mises stress on the axis in a part of the contact: {z in a, value in the unit of the case}. */
  function peak(contact, ev, field, part) {
    return part === "asperities" ? Stress.spot(ev, field) : Stress.peak(field, part, contact.inputs.v.nu_punch.value);
  }

  /** What the contact bears: {field, parts: [{part, z, mises, strength (NaN: not known), share}], edge, below: sr of the
      layer at the interface, cracks: its fracture strength}, in SI but z in a. */
  function stresses(contact) {
    const { ev, case_ } = contact, field = Stress.field(ev), limits = strengths(contact);
    const there = { punch: case_.p.m > 0, layer: field.layer, body: field.body, asperities: case_.p.rough };
    const parts = Object.keys(INPUTS).filter((part) => there[part]).map((part) => {
      const { z, value } = peak(contact, ev, field, part), mises = value * case_.unit, strength = limits[part];
      return { part, z, mises, strength, share: mises / strength };
    });
    const edge = field.edge() * case_.unit, below = field.layer && field.layer(field.h).sr * case_.unit;
    const cracks = (field.layer && Contact.MATERIALS[contact.texts.layer]?.cracks) || NaN; // fracture strength of the layer
    return { field, parts, edge, below, cracks };
  }

  /** The load in SI from which a part of the contact yields on the axis: a generator, which pauses after each contact that it
      solves. It returns {P, a in R}; {P, a, above: "end" | "film" | "open"} where nothing yields up to this load, at which a = 0.2 R,
      the layer is too thin for the page, or there is no solution; {P, a, below: true} where the first contact that is solved
      yields. The radius rises step by step, as the stress does not grow with the load everywhere. */
  function* load(contact, { part, strength }) {
    const { case_ } = contact, { p, unit } = case_, n = p.layered ? p.n : 1, limit = strength / unit, end = DATA.limits.STEEP;
    const at = (a) => {
      const solved = Core.solve({ ...p, control: "a", value: a }, true);
      if (solved.status !== "converged") return { a, status: solved.status };
      const by = Math.log(peak(contact, solved.ev, Stress.field(solved.ev), part).value / limit);
      return Number.isFinite(by) ? { a, P: solved.Q.P, by } : { a, status: "open" };
    };
    if (!(limit > 0)) return { P: NaN, a: NaN };
    const ended = ({ P, a }) => ({ P: P * case_.units.P, a });
    const never = part === "asperities" ? NO_SPOT * limit / (p.layered ? n || 1 : 1) * Math.sqrt(p.Ra) : NEVER * limit / Math.max(n, 1);
    let low = null, high = null;
    for (let a = Math.min(end, Math.max(NARROWEST, never)); !high; a = Math.min(end, STEP * a)) {
      const next = at(a);
      yield;
      if (next.status) {
        const above = next.status === "film" ? "film" : "open";
        if (low) return { ...ended(low), above };
        if (a === end || above === "film") return { P: NaN, a, above };
      } else if (next.by > 0) high = next;
      else if (a === end) return { ...ended(next), above: "end" };
      else low = next;
    }
    if (!low) return { ...ended(high), below: true };
    for (let count = 0, side = 0; count < 30; count++) {
      const next = at(low.a * (high.a / low.a) ** (low.by / (low.by - high.by)));
      yield;
      if (next.status) return { ...ended(low), above: "open" };
      if (Math.abs(next.by) < SAME) return ended(next);
      // the end that stays twice counts half, or it would stay for ever
      if (next.by < 0) { low = next; if (side < 0) high = { ...high, by: high.by / 2 }; side = -1; } else { high = next; if (side > 0) low = { ...low, by: low.by / 2 }; side = 1; }
    }
    return ended(low);
  }

  return { stresses, strengths, load, INPUTS };
})(...(typeof module === "undefined" ? [Core, Stress, Contact, DATA]
  : [require("./core.js"), require("./stress.js"), require("./contact.js"), globalThis.DATA]));
if (typeof module !== "undefined") module.exports = Strength;

"use strict";
/* Drawings as SVG: the section with p(r) and λ(r), and the tornado. */
const Drawing = ((Core, Contact) => {
  const escaped = (text) => String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
  const path = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
  const text = (x, y, words, { anchor = "start", soft = false, clear = false, fill = "" } = {}) =>
    `<text x="${x}" y="${y}" text-anchor="${anchor}"${soft ? ` class="soft${clear ? " clear" : ""}"` : ""}${fill ? ` style="fill:${fill}"` : ""}>${escaped(words)}</text>`;
  const svg = (width, height, label, inside) => `<svg viewBox="0 0 ${width} ${height}" role="img" aria-label="${escaped(label)}">${inside}</svg>`;

  /** Round numbers from 0 to about `top`. */
  function ticks(top, count = 4) {
    const rough = top / count, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 2.5, 5, 10].find((f) => f * power >= rough * 0.999) * power;
    return Array.from({ length: Math.floor(top / step + 1e-9) + 1 }, (_, i) => i * step);
  }

  const WIDE = 1.5; // radii are drawn up to this times a

  /** p(r) and λ(r) over the section, both with one scale of r; below, heights have that scale too. */
  function section(contact, width) {
    const { ev, case_, Q, texts } = contact, rough = case_.p.rough, narrow = width < 520;
    const left = narrow ? 44 : 64, right = rough ? (narrow ? 34 : 56) : 16, top = 26, high = 150, gap = 34, deep = narrow ? 120 : 190;
    const inner = width - left - right, middle = left + inner / 2, perA = inner / 2 / WIDE, base = top + high;
    const at = (x) => middle + x * perA;
    const xs = Array.from({ length: 97 }, (_, i) => Math.sin(Math.PI / 2 * (i / 48 - 1)));
    const values = xs.map((x) => Core.profile(ev, Math.abs(x)));
    const limits = contact.limits.filter((own) => own.Q);
    const mine = Math.max(...values.map((v) => v.p * case_.unit)); // limits that are far larger end at the frame
    const most = 1.06 * Math.max(mine, ...limits.map((own) => Math.min(own.Q.p0, 1.5 * mine)));
    const [word, size] = Contact.UNITS.Pa.write.find((row) => most >= row[1]) || ["Pa", 1];
    const yOf = (p) => base - p / most * high;
    let out = `<clipPath id="frame"><rect x="${left}" y="${top}" width="${inner}" height="${high}"/></clipPath>`;
    for (const tick of ticks(most / size)) {
      const y = yOf(tick * size);
      out += `<path d="M${left} ${y}H${left + inner}" stroke="var(--line)"/>${text(left - 6, y + 4, Number(tick.toPrecision(6)), { anchor: "end", soft: true })}`;
    }
    out += text(left - 6, 14, `p in ${word}`, { anchor: narrow ? "start" : "middle", fill: "var(--pressure)" }).replace(`x="${left - 6}"`, `x="${narrow ? 2 : left}"`);
    const dashes = ["5 4", "1.5 3"];
    limits.forEach((own, i) => {
      const points = xs.map((x) => [at(x * own.Q.a / Q.a), yOf(own.Q.p0 * Math.sqrt(1 - x * x))]);
      out += `<path d="${path(points)}" clip-path="url(#frame)" fill="none" stroke="var(--soft)" stroke-dasharray="${dashes[i]}"/>`;
    });
    if (rough) {
      const full = Math.min(1.06, 1.15 * Math.max(...values.map((v) => v.lam)));
      out += `<path d="${path(xs.map((x, i) => [at(x), base - values[i].lam / full * high]))}" fill="none" stroke="var(--area)" stroke-width="2"/>`;
      for (const tick of ticks(full)) out += text(left + inner + 6, base - tick / full * high + 4, Number(tick.toPrecision(6)), { soft: true });
      out += text(width - 2, 14, "λ", { anchor: "end", fill: "var(--area)" });
    }
    out += `<path d="${path(xs.map((x, i) => [at(x), yOf(values[i].p * case_.unit)]))}" fill="none" stroke="var(--pressure)" stroke-width="2.5"/>`;
    // legend of the dashed lines
    let place = left + (narrow ? 70 : 110);
    limits.forEach((own, i) => {
      out += `<path d="M${place} 10h22" stroke="var(--soft)" stroke-dasharray="${dashes[i]}"/>${text(place + 27, 14, own.name, { soft: true })}`;
      place += narrow ? 105 : 125;
    });
    return svg(width, base + gap + deep + 26, describe(contact), out + below(contact, { left, inner, middle, perA, at, zero: base + gap + deep * 0.42, base, gap, deep, narrow, texts }));
  }

  /** The section to scale: surfaces as they are under the load; dashed, the layer before it. */
  function below(contact, d) {
    const { ev, case_, Q } = contact, R = case_.R / Q.a, layered = case_.p.layered, low = d.base + d.gap + d.deep, high = d.base + d.gap;
    const xs = Array.from({ length: 61 }, (_, i) => (i / 30 - 1) * WIDE), depth = Q.D / Q.a, own = 1 / ev.a;
    const u = Core.displacements(ev, xs.slice(30)), of = (i) => u[Math.abs(i - 30)];
    const yOf = (z) => Math.min(low, Math.max(high, d.zero + z * d.perA));
    const ball = xs.map((x, i) => [d.at(x), yOf(depth - x * x / (2 * R) - of(i).punch * own)]);
    const surface = xs.map((x, i) => [d.at(x), Math.max(ball[i][1], yOf((of(i).both - of(i).punch) * own))]);
    const h = layered ? case_.p.h / ev.a : 0, bottom = yOf(h), left = d.at(-WIDE), right = d.at(WIDE);
    let out = `<path d="M${left} ${high}${path(ball).replace("M", "L")}L${right} ${high}Z" fill="var(--ball)"/>`;
    out += `<path d="${path(surface)}L${right} ${low}L${left} ${low}Z" fill="var(--body)"/>`;
    if (layered) {
      const edge = surface.map(([x, y]) => [x, Math.max(y, bottom)]).reverse();
      out += `<path d="${path(surface)}${path(edge).replace("M", "L")}Z" fill="var(--layer)"/>`;
      if (bottom < low) out += `<path d="M${left} ${bottom}H${right}" stroke="var(--soft)" stroke-dasharray="4 4"/>`;
    }
    out += `<path d="M${left} ${d.zero}H${right}" stroke="var(--soft)" stroke-dasharray="4 4"/><path d="${path(surface)}" fill="none" stroke="var(--ink)" stroke-width="1.5"/>`;
    for (const x of [-1, 1]) out += `<path d="M${d.at(x)} ${d.base}V${d.zero}" stroke="var(--line)"/>`;
    out += `<path d="M${d.middle} ${d.base + 18}H${d.at(1)}m-6 -4l6 4l-6 4" fill="none" stroke="var(--ink)"/>`;
    out += text(d.middle - 6, d.base + 22, `a = ${Contact.shown({ ...contact, spread: {} }, "a").whole}`, { anchor: "end" });
    out += text(d.middle, high + 16, "ball", { anchor: "middle" });
    const thick = bottom - d.zero, show = (E) => Contact.readable(E, "Pa", 3);
    if (layered) {
      const name = `layer, h = ${Contact.readable(case_.p.h * case_.R, "m", 3)}`;
      out += thick > 16 ? text(left + 8, Math.min(d.zero + thick / 2 + (thick > 44 ? 12 : 4), low - 6), name) : text(left + 8, d.zero - 8, name);
    }
    if (low - bottom > 24) out += text(left + 8, Math.min(low - 8, bottom + (thick > 16 ? 18 : 22)), d.texts.body === "rigid" ? "rigid body" : `body, E = ${show(contact.inputs.v.E2.value)}`);
    const [word, size] = Contact.UNITS.m.write.find((row) => Q.a >= row[1]) || ["nm", 1e-9], power = 10 ** Math.floor(Math.log10(Q.a / size));
    const bar = power * (Q.a / size >= 5 * power ? 5 : Q.a / size >= 2 * power ? 2 : 1), long = bar * size / Q.a * d.perA;
    out += `<path d="M${left} ${low + 10}h${long}m0 -4v8m${-long} 0v-8" fill="none" stroke="var(--ink)"/>`;
    return out + text(left + long + 8, low + 14, `${Number(bar.toPrecision(3))} ${word}${d.narrow ? " (dashed: unloaded)" : ", in both directions; dashed: before loading"}`, { soft: true });
  }

  const LEAST = 0.24; // of the height a layer has this at least, and is then drawn stretched

  /** Stresses over the depth on the axis: von Mises' (thick), radial and axial; the strengths of layer and body dashed. */
  function stresses(contact, own, width) {
    const { case_, Q } = contact, { h } = own.field, layered = Boolean(own.field.layer), narrow = width < 520;
    const left = narrow ? 44 : 64, right = 16, top = 40, high = 250, inner = width - left - right, end = own.field.body ? Math.max(1.5, Math.min(3, 2.5 * h)) : h;
    const inLayer = layered ? Math.min(h, end) : 0, part = inLayer < end ? Math.max(inLayer / end, layered ? LEAST : 0) : 1, stretched = layered && part > inLayer / end;
    const yOf = (z) => top + high * (z <= inLayer ? part * z / (inLayer || 1) : part + (1 - part) * (z - inLayer) / (end - inLayer));
    const drawn = [[own.field.layer, 0, inLayer, "layer"], [own.field.body, h, end, "body"]].filter(([field, low, to]) => field && to > low).map(([field, low, to, body]) => {
      const zs = Array.from({ length: 41 }, (_, i) => low + (to - low) * (i / 40) ** 1.5);
      return { body, low, to, rows: zs.map((z) => ({ z, ...field(z) })) };
    });
    const all = drawn.flatMap(({ rows }) => rows.flatMap((row) => [row.mises, row.sr, row.sz])).map((value) => value * case_.unit);
    const [least, most] = [Math.min(0, ...all), Math.max(...all)], span = 1.05 * (most - least), [word, size] = unitOf("Pa", Math.max(most, -least));
    const xOf = (value) => left + (value - least + 0.02 * span) / span * inner;
    let out = layered ? `<rect x="${left}" y="${top}" width="${inner}" height="${yOf(inLayer) - top}" fill="var(--layer)" opacity="0.25"/>` : "";
    const step = ticks(span / size, narrow ? 4 : 7)[1] || 1;
    for (let tick = Math.ceil(least / size / step) * step; tick * size <= most * 1.02; tick += step) {
      const x = xOf(tick * size);
      out += `<path d="M${x} ${top}V${top + high}" stroke="var(--line)"/>${text(x, top - 6, String(Number(tick.toPrecision(6))).replace("-", "−"), { anchor: "middle", soft: true })}`;
    }
    const [long, metre] = unitOf("m", end * Q.a), under = stretched ? inLayer : 0;
    const marks = [...(stretched ? [0, inLayer] : []), ...ticks(end * Q.a / metre, narrow ? 4 : 5).map((tick) => tick * metre / Q.a)];
    marks.filter((z, i) => !stretched || i < 2 || yOf(z) > yOf(under) + 12).forEach((z) => {
      out += `<path d="M${left - 4} ${yOf(z)}h4" stroke="var(--soft)"/>${text(left - 7, yOf(z) + 4, Number((z * Q.a / metre).toPrecision(3)), { anchor: "end", soft: true })}`;
    });
    out += text(2, 14, `depth in ${long}, stress in ${word}, tension positive`, { soft: true });
    const limit = ["", narrow ? "strength" : "yield strength", 'stroke="var(--beyond)" stroke-width="1.5" stroke-dasharray="2 3"'];
    const looks = [["mises", "von Mises", 'stroke="var(--pressure)" stroke-width="2.5"'], ["sr", "radial", 'stroke="var(--area)" stroke-width="1.5"'], ["sz", "axial", 'stroke="var(--soft)" stroke-width="1.5" stroke-dasharray="5 4"']];
    for (const { rows } of drawn) {
      for (const [name, , look] of looks) out += `<path d="${path(rows.map((row) => [xOf(row[name] * case_.unit), yOf(row.z)]))}" fill="none" ${look}/>`;
    }
    const strong = drawn.map((row) => ({ ...row, strength: own.parts.find(({ part }) => part === row.body)?.strength })).filter((row) => row.strength <= most);
    for (const { low, to, strength } of strong) out += `<path d="M${xOf(strength)} ${yOf(low)}V${yOf(to)}" ${limit[2]}/>`;
    out += `<path d="M${left} ${top}V${top + high}M${xOf(0)} ${top}V${top + high}" stroke="var(--soft)"/>`;
    let place = narrow ? 4 : left;
    for (const [, name, look] of strong.length ? [...looks, limit] : looks) {
      out += `<path d="M${place} ${top + high + 16}h22" ${look}/>${text(place + 27, top + high + 20, name, { soft: true })}`;
      place += (narrow ? 34 : 38) + 6.5 * name.length;
    }
    if (layered) out += text(left + inner - 6, top + 15, stretched ? (narrow ? "layer, stretched" : "layer, its depth stretched") : "layer", { anchor: "end", soft: true, clear: true });
    if (own.field.body && inLayer < end) out += text(left + inner - 6, top + high - 6, "body", { anchor: "end", soft: true, clear: true });
    const row = own.parts.reduce((one, other) => (other.mises > one.mises ? other : one));
    return svg(width, top + high + 26, `Stresses on the axis over the depth; the largest von Mises stress, ${Contact.readable(row.mises, "Pa")}, is in the ${{ punch: "ball", asperities: "central asperity" }[row.part] || row.part}.`, out);
  }

  const unitOf = (unit, value) => Contact.UNITS[unit].write.find((row) => value >= row[1]) || Contact.UNITS[unit].write.at(-1);

  function describe(contact) {
    const show = (name) => Contact.shown(contact, name).whole;
    return `Pressure over the radius: ${show("p0")} in the centre, 0 at a = ${show("a")}. Below it the section through ball, layer and body, to scale.`;
  }

  /** Bars: by how much a result changes with each input. */
  function tornado(contact, result, by, width) {
    const rows = Object.entries(contact.sensitivities).map(([name, own]) => {
      const step = by === "spread" ? own.relative : name.startsWith("nu") ? 0.03 : 0.1;
      return { name, change: by === "spread" || name.startsWith("nu") ? own[result] * step : 1.1 ** own[result] - 1 };
    }).filter((row) => Math.abs(row.change) > 5e-6).sort((one, two) => Math.abs(two.change) - Math.abs(one.change));
    if (!rows.length) {
      return `<p class="note">${by === "spread" ? "No input that counts has a ±: write one as in “200 ± 10 GPa”, or name a material." : "No input changes it."}</p>`;
    }
    const narrow = width < 520, left = narrow ? 92 : 250, right = 76, line = 24, inner = width - left - right;
    const most = Math.max(...rows.map((row) => Math.abs(row.change))), sided = by !== "spread", middle = sided ? left + inner / 2 : left;
    let out = "";
    rows.forEach((row, i) => {
      const y = i * line, change = sided ? row.change : Math.abs(row.change), long = change / most * (sided ? inner / 2 : inner);
      out += text(left - 8, y + 16, narrow ? row.name : Contact.INPUTS[row.name].label, { anchor: "end" });
      out += `<rect x="${long < 0 ? middle + long : middle}" y="${y + 4}" width="${Math.max(Math.abs(long), 0.8)}" height="16" fill="${long < 0 ? "var(--area)" : "var(--pressure)"}"/>`;
      out += text(width - 4, y + 16, `${sided && change > 0 ? "+" : ""}${change < 0 ? "−" : ""}${Contact.percent(Math.abs(change))}`, { anchor: "end" });
    });
    out += `<path d="M${middle} 0V${rows.length * line}" stroke="var(--soft)"/>`;
    const first = rows[0], label = `${Contact.RESULTS[result].label} depends most on ${Contact.INPUTS[first.name].label}: ${Contact.percent(first.change)}.`;
    return svg(width, rows.length * line + 4, label, out);
  }

  return { section, stresses, tornado, ticks };
})(Core, Contact);

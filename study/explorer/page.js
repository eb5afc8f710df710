"use strict";
/* The form, and what is shown of the contact that it describes. */
(() => {
  const $ = (id) => document.getElementById(id);
  let texts = Contact.fromHash(location.hash), contact = null, copy = "command", waiting = false, later = 0, addressed = 0, seen = location.hash, drawn = "";
  let width = 0; // of drawings; 0: to be asked, which makes the browser lay the page out
  /** What was typed before a material or no layer took its place. */
  const kept = { E_punch: "210 GPa", nu_punch: "0.3", E1: "200 GPa", nu1: "0.25", h: "2 um", E2: "210 GPa", nu2: "0.3",
    layer: "DLC a-C:H", Nbar: "4 1/um^2", Ra: "2 um" };
  const OWN = "own E and ν", NONE = "no layer";

  /* ---- form ---- */

  function make() {
    for (const box of document.querySelectorAll("[data-field]")) field(box, box.dataset.field);
    for (const box of document.querySelectorAll("[data-body]")) material(box, box.dataset.body);
    choice("bonding", [["bonded", "bonded"], ["frictionless", "slides"]], () => texts.bonding, (value) => { texts.bonding = value; });
    choice("micro", [["smooth", "smooth"], ["disc_cell", "rough: asperities"]], () => texts.micro, (value) => {
      texts.micro = value;
      if (value === "disc_cell") for (const name of ["Nbar", "Ra"]) texts[name] ??= kept[name];
    });
    choice("control", [["P", "load P"], ["a", "radius a"], ["D", "depth D"]], () => Contact.CONTROLS.find((name) => texts[name] !== undefined), control);
    choice("copy", [["command", "command line"], ["python", "Python"], ["toml", "study file (TOML)"], ["stresses", "stresses with friction"]], () => copy, (value) => { copy = value; });
    for (const id of ["tornado-of", "map-of"]) for (const [name, own] of Object.entries(Contact.RESULTS)) $(id).add(new Option(`${own.label} ${own.symbol}`, name));
    $("tornado-of").value = "p0";
    $("map-of").value = "p0";
    for (const id of ["tornado-of", "tornado-by", "map-of", "map-x", "map-y", "map-wide"]) $(id).addEventListener("change", redraw);
    $("restart").addEventListener("click", () => change(Contact.fromHash("")));
    $("copy").addEventListener("click", () => toClipboard($("copied").textContent));
    $("copy-link").addEventListener("click", () => toClipboard(location.href.replace(/#.*|$/, Contact.toHash(texts))));
    $("version").textContent = DATA.version;
    addEventListener("hashchange", () => {
      seen = location.hash;
      if (seen !== Contact.toHash(texts)) change(Contact.fromHash(seen));
    });
    addEventListener("resize", () => { width = 0; redraw(); });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", ContactMap.paint);
    change(texts);
  }

  /** A text with unit, and a slider on a logarithmic scale (of a Poisson ratio linear). */
  function field(box, name) {
    const own = Contact.INPUTS[name] || Contact.STRENGTHS[name], ratio = own.unit === "1", [low, high] = own.range || [];
    box.className = "field";
    box.dataset.field = name;
    box.innerHTML = `<label>${own.short} <input type="text" id="in-${name}" aria-label="${own.label}" aria-describedby="wrong-${name}" spellcheck="false"${own.range ? "" : ' placeholder="not known"'}></label>
      ${own.range ? `<input type="range" min="0" max="1000" step="1" aria-label="${own.label}, slider">` : ""}<p class="complaint" id="wrong-${name}" hidden></p>`;
    const [input, slider] = box.querySelectorAll("input");
    input.addEventListener("input", () => { texts[name] = input.value; redraw(); });
    slider?.addEventListener("input", () => {
      const share = slider.value / 1000, value = ratio ? low + (high - low) * share : low * (high / low) ** share;
      texts[name] = withSpread(name, value);
      input.value = texts[name];
      redraw();
    });
  }

  /** A number moved by the slider, with the relative spread that was typed. */
  function withSpread(name, value) {
    const text = ContactMap.textOf(name, value, 3);
    try {
      const before = Contact.parse(name, texts[name]);
      if (!before.spread) return text;
      return `${text} ± ${Number((100 * before.spread / before.value).toPrecision(2))} %`;
    } catch { return text; }
  }

  function material(box, body) {
    const names = DATA.materials.map((own) => own.name), extra = body === "layer" ? [NONE] : ["rigid"];
    const called = { punch: "material of the ball", layer: "material of the layer", body: "material of the body" }[body];
    box.className = "field";
    box.innerHTML = `<label>material <select id="in-${body}" aria-label="${called}">${[...extra, OWN, ...names].map((name) => `<option>${name}</option>`).join("")}</select></label>
      <p class="complaint" id="wrong-${body}" hidden></p><p class="hint"></p>`;
    const select = box.querySelector("select");
    box.after(...numbersOf(body).map((name) => {
      const line = document.createElement("div");
      field(line, name);
      return line;
    }));
    select.addEventListener("change", () => {
      const own = Contact.BODIES[body], value = select.value;
      if (body === "layer") { delete texts.base; texts.h ??= kept.h; }
      if (value === OWN) { // the numbers of the material that was chosen, to be changed
        for (const name of own) texts[name] = contact?.inputs?.v[name] && Number.isFinite(contact.inputs.v[name].value) ? ContactMap.textOf(name, contact.inputs.v[name].value) : kept[name];
        ContactMap.keepStrength(texts, body);
        delete texts[body];
      } else if (value === NONE) texts.base = "half_space";
      else texts[body] = value;
      change(texts);
    });
  }

  /** Modulus, Poisson ratio and strength of a material of one's own. */
  const numbersOf = (body) => [...Contact.BODIES[body], ...Object.keys(Contact.STRENGTHS).filter((name) => Contact.STRENGTHS[name].body === body)];

  function choice(key, options, value, set) {
    const box = document.querySelector(`[data-choice="${key}"]`);
    box.innerHTML = options.map(([word, label]) => `<label><input type="radio" name="${key}" value="${word}">${label}</label>`).join("");
    box.addEventListener("change", (event) => { set(event.target.value); change(texts); });
    box.show = () => { for (const radio of box.querySelectorAll("input")) radio.checked = radio.value === value(); };
  }

  /** Another control: its number is that of the contact as it is. */
  function control(name) {
    const value = contact?.Q ? contact.Q[name] : Contact.INPUTS[name].range[0];
    for (const other of Contact.CONTROLS) delete texts[other];
    texts[name] = ContactMap.textOf(name, value);
  }

  /** Take new texts, and show them in the form. */
  function change(next) {
    texts = next;
    const layered = texts.base !== "half_space";
    for (const body of Object.keys(Contact.BODIES)) {
      const select = $(`in-${body}`);
      select.value = body === "layer" && !layered ? NONE : texts[body] ?? OWN;
      for (const name of numbersOf(body)) document.querySelector(`[data-field="${name}"]`).hidden = select.value !== OWN;
    }
    for (const name of Object.keys(Contact.INPUTS)) if (texts[name] !== undefined) $(`in-${name}`).value = texts[name];
    for (const name of Object.keys(Contact.STRENGTHS)) $(`in-${name}`).value = texts[name] ?? "";
    document.querySelector('[data-field="h"]').hidden = !layered;
    document.querySelector('[data-choice="bonding"]').hidden = !layered;
    for (const name of Contact.CONTROLS) document.querySelector(`[data-field="${name}"]`).hidden = texts[name] === undefined;
    for (const name of ["Nbar", "Ra"]) document.querySelector(`[data-field="${name}"]`).hidden = texts.micro !== "disc_cell";
    for (const box of document.querySelectorAll("[data-choice]")) box.show();
    redraw();
  }

  /* ---- results ---- */

  function redraw() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; show(); });
  }

  function show() {
    const begin = performance.now(), found = Contact.solve(texts);
    ContactMap.stop();
    contact = found.inputs ? found : contact && { ...contact, Q: null, inputs: Contact.read(texts) };
    complaints(found.problems);
    slides(Contact.read(texts).v);
    $("copied").textContent = Contact.COPIES[copy](texts);
    const solved = found.status === "converged";
    for (const box of document.querySelectorAll("#results > section")) box.hidden = !solved && !["answer-title", "copy-title"].includes(box.getAttribute("aria-labelledby"));
    $("trouble").replaceChildren(...(solved ? [] : [Object.assign(document.createElement("p"), { textContent: trouble(found) })]));
    $("words").hidden = $("numbers").hidden = !solved;
    clearTimeout(addressed); // it takes some milliseconds: not while a slider moves
    if (Object.keys(found.problems).length === 0) addressed = setTimeout(address, 100);
    clearTimeout(later);
    $("brief").textContent = solved ? ["a", "D", "p0"].map((name) => `${Contact.RESULTS[name].symbol} ${Contact.shown({ ...found, spread: {} }, name).whole}`).join(" · ") : "no solution";
    if (!solved) return;
    const words = Contact.words(found);
    $("words").innerHTML = "";
    words.forEach((sentence, i) => {
      const last = i === words.length - 1;
      if (i === 0 || last || i === 2) $("words").append(Object.assign(document.createElement("p"), { className: last ? "last" : i === 0 ? "first" : "" }));
      $("words").lastChild.append(`${sentence} `);
    });
    table(found);
    width ||= Math.max(320, Math.min(960, $("section").clientWidth));
    $("section").innerHTML = Drawing.section(found, width);
    lights(found);
    $("tornado").innerHTML = Drawing.tornado(found, $("tornado-of").value, $("tornado-by").value, width);
    $("time").textContent = `Solved and drawn in ${(performance.now() - begin).toFixed(0)} ms.`;
    $("map").ariaBusy = "true"; // until it is whole
    $("stresses").ariaBusy = "true";
    later = setTimeout(() => stresses(found), 150);
  }

  /** Put the contact into the address, unless somebody has just put another there. */
  function address() {
    if (location.hash === seen) history.replaceState(null, "", Contact.toHash(texts));
    seen = location.hash;
  }

  function trouble(found) {
    const command = "The command below solves it.";
    if (found.status === "film") return `The layer is thinner than 1/256 of the contact radius (about ${Contact.readable(found.a * found.case_.R, "m")}). This page does not solve that. ${command}`;
    if (found.status === "apart") return `The asperities are farther apart than the layer is thick (pitch 1/√N̄ = ${Contact.readable(1 / Math.sqrt(found.inputs.v.Nbar.value), "m")}): they press on the body through it. This page does not solve that. ${command}`;
    if (found.status === "lift_off") return "The ball lifts off inside the contact, or the pressure is tensile there: there is no full disc of contact, and the model has no solution.";
    if (found.status === "open") return `This page finds no solution here. ${command.replace("solves it", "may solve it, or says what is wrong")}`;
    const elsewhere = Object.keys(Contact.CHOICES).map((name) => found.problems[name]).filter(Boolean); // of the address
    return elsewhere.length ? `${elsewhere.join("; ")}. The command below may solve it.` : "Some input is missing or wrong; see the form.";
  }

  function complaints(problems) {
    for (const name of [...Object.keys(Contact.INPUTS), ...Object.keys(Contact.STRENGTHS), ...Object.keys(Contact.BODIES)]) {
      const line = $(`wrong-${name}`);
      line.textContent = problems[name] || "";
      line.hidden = !problems[name];
      line.parentElement.classList.toggle("wrong", Boolean(problems[name]));
    }
  }

  /** Put the sliders where the numbers are, and say of materials what they stand for. */
  function slides(v) {
    for (const [name, own] of Object.entries(Contact.INPUTS)) {
      const slider = document.querySelector(`[data-field="${name}"] input[type="range"]`), [low, high] = own.range;
      if (!v[name]) continue;
      const share = own.unit === "1" ? (v[name].value - low) / (high - low) : Math.log(v[name].value / low) / Math.log(high / low);
      slider.value = Math.round(1000 * Math.min(1, Math.max(0, share)));
      slider.setAttribute("aria-valuetext", texts[name] || "");
    }
    for (const body of Object.keys(Contact.BODIES)) {
      const own = Contact.MATERIALS[texts[body]], hint = document.querySelector(`[data-body="${body}"] .hint`), shown = own && !(body === "layer" && texts.base === "half_space");
      hint.textContent = shown ? `E = ${Contact.written(own.E, "Pa", 4, own.E_spread).whole}, ν = ${Contact.written(own.nu, "1", 3, own.nu_spread).whole}` : "";
      hint.title = shown ? `${own.condition}. ${own.source}` : "";
    }
    $("diameter").textContent = v.R ? `diameter ${Contact.readable(2 * v.R.value, "m", 4)}` : "";
  }

  function table(found) {
    const names = Object.keys(Contact.RESULTS).filter((name) => found.case_.p.rough || !["p_max", "Ar_An"].includes(name));
    const head = ["", "", "this contact", ...found.limits.map((own) => own.name)].map((word) => `<th scope="col">${word}</th>`).join("");
    const rows = names.map((name) => {
      const { label, symbol, unit } = Contact.RESULTS[name];
      const others = found.limits.map((own) => `<td class="limit">${own.Q && own.Q[name] !== null ? Contact.readable(own.Q[name], unit, 4) : "–"}</td>`).join("");
      return `<tr><th scope="row">${label}</th><td>${symbol}</td><td class="value" data-result="${name}">${Contact.shown(found, name).whole.replace(/± .*$/, '<span class="pm">$&</span>')}</td>${others}</tr>`;
    });
    if (found.ring) {
      const ring = `<tr><th scope="row">largest nominal pressure, in a ring at r = ${Contact.readable(found.ring.r, "m")}</th><td>pring</td><td class="value" data-result="p_ring">${Contact.readable(found.ring.p, "Pa", found.digits)}</td>${found.limits.map(() => "<td></td>").join("")}</tr>`;
      rows.splice(names.indexOf("p0") + 1, 0, ring);
    }
    $("numbers").innerHTML = `<caption class="note">Beside: Hertz's smooth contact of the same ball and ${Contact.RESULTS[found.inputs.control].label}.</caption><thead><tr>${head}</tr></thead><tbody>${rows.join("")}</tbody>`;
  }

  function lights(found) {
    const words = { good: "holds", near: "nearly", beyond: "fails" };
    $("lights").innerHTML = found.lights.map((row) => `<li data-name="${row.name}" data-state="${row.state}"><span class="state ${row.state}">${words[row.state]}</span><span>${row.title}</span><span class="size">${row.size}</span></li>`).join("");
  }

  const PARTS = { punch: "ball", layer: "layer", body: "body", asperities: "asperity" };

  /** Stresses on the axis, and what of its strength each part bears; then the loads of first yield, and the map. */
  function stresses(found) {
    const own = Strength.stresses(found), { parts } = own, digits = Math.min(3, found.digits);
    $("stresses").innerHTML = Drawing.stresses(found, own, width);
    const share = (row) => Numbers.part(row.share);
    const state = (row) => (row.share > 1 ? "beyond" : row.share > 0.5 ? "near" : "good"), known = parts.filter((row) => Number.isFinite(row.strength));
    const rows = [
      ["largest von Mises stress", (row) => Contact.readable(row.mises, "Pa", digits)],
      ["its depth below the surface", (row) => Contact.readable(row.z * found.Q.a, "m", 2)],
      ["yield strength", (row) => (known.includes(row) ? Contact.readable(row.strength, "Pa") : "not known")],
      ["share of that", (row) => (known.includes(row) ? `<span class="${state(row)}">${share(row)}</span>` : "–")],
      ["yields from P =", (row) => (known.includes(row) ? `<span data-load="${row.part}">…</span>` : "–")],
    ].map(([name, cell]) => `<tr><th scope="row">${name}</th>${parts.map((row) => `<td>${cell(row)}</td>`).join("")}</tr>`);
    const heads = ["", ...parts.map((row) => PARTS[row.part])].map((word) => `<th scope="col">${word}</th>`).join("");
    $("strengths").innerHTML = `<thead><tr>${heads}</tr></thead><tbody>${rows.join("")}</tbody>`;
    const nearest = known.reduce((one, other) => (one?.share > other.share ? one : other), null);
    $("verdict").textContent = nearest === null ? "No strength is known of these bodies: choose “own E and ν” to give one."
      : `On the axis the ${nearest.part === "asperities" ? "central asperity" : PARTS[nearest.part]} is nearest to its limit: it bears ${share(nearest)}${nearest.share < 1 ? " of" : ""} its yield strength.${nearest.share > 1 ? " The results are those of bodies that stay elastic." : ""}`;
    $("verdict").className = nearest ? state(nearest) : "";
    const show = (value) => `${Contact.readable(Math.abs(value), "Pa")} ${value < 0 ? "of pressure" : "of tension"}`;
    const torn = (value) => (value > 0 && own.cracks ? `, ${Contact.percent(value / own.cracks)} of the layer's fracture strength` : "");
    const edge = Number.isNaN(own.edge) ? "" : `At the edge of the contact the surface bears ${show(own.edge)} along r${torn(own.edge)}. `;
    const under = own.below === null ? "" : `On the axis the underside of the layer bears ${show(own.below)} along r${torn(own.below)}. `;
    const aside = own.below === null ? "" : "A layer may bear more beside the axis, near the edge. ";
    $("stress-note").textContent = `${edge}${under}On the axis Tresca's stress is von Mises'. ${aside}Stresses beside the axis and under friction: “stresses with friction” at the foot of this page.`;
    $("stresses").ariaBusy = "false";
    const search = loads(found, known);
    (function some() { // the page answers between the contacts that are solved
      const end = performance.now() + 8;
      while (performance.now() < end) if (search.next().done) { later = setTimeout(() => map(found), 0); return; }
      later = setTimeout(some, 0);
    })();
  }

  /** Write the loads of first yield; a generator. */
  function* loads(found, parts) {
    const ends = new Set();
    for (const row of parts) {
      const { P, a, above, below } = yield* Strength.load(found, row), { p } = found.case_, cell = document.querySelector(`[data-load="${row.part}"]`);
      const text = Contact.readable(P, "N"), first = row.part === "asperities" && p.Nbar * Math.PI * a * a < 1;
      cell.textContent = above ? (Number.isNaN(P) ? "not on this page" : `above ${text}`) : first ? "first touch" : below ? `below ${text}` : text;
      if (above) ends.add({ end: "a = 0.2 R", film: "where the layer is too thin for this page", open: "where this page finds no solution" }[above]);
    }
    if (ends.size) $("stress-note").textContent += ` “Above”: looked for up to ${[...ends].join(", or ")}.`;
  }

  function map(found) {
    const names = Object.keys(found.sensitivities);
    ["map-x", "map-y"].forEach((id, i) => {
      const select = $(id), before = select.value;
      if (names.join() !== [...select.options].map((one) => one.value).join()) {
        select.replaceChildren(...names.map((name) => new Option(Contact.INPUTS[name].label, name)));
        const first = [names.includes("h") ? "h" : "R", found.inputs.control];
        select.value = names.includes(before) ? before : first[i];
      }
    });
    if ($("map-x").value === $("map-y").value) $("map-y").value = names.find((name) => name !== $("map-x").value);
    const key = [Contact.toHash(texts), ...["map-of", "map-x", "map-y", "map-wide"].map((id) => $(id).value)].join(" ");
    if (key === drawn) { $("map").ariaBusy = "false"; return; }
    drawn = key;
    const chosen = { of: $("map-of").value, x: $("map-x").value, y: $("map-y").value, wide: Number($("map-wide").value) };
    ContactMap.draw($("map"), found, chosen, (next) => change(next));
  }

  async function toClipboard(text) {
    try { await navigator.clipboard.writeText(text); } catch {
      const area = Object.assign(document.createElement("textarea"), { value: text });
      document.body.append(area);
      area.select();
      document.execCommand("copy");
      area.remove();
    }
    $("copy-said").textContent = "copied";
    setTimeout(() => { $("copy-said").textContent = ""; }, 2000);
  }

  make();
})();

"use strict";
/* The map: a result over two inputs, 24 x 24 contacts on 16 nodes each, solved a few milliseconds at a time. */
const ContactMap = ((Contact, Drawing) => {
  const SIDE = 24, LEFT = 72, TOP = 10, BAR = 104, BELOW = 46;
  let CELL = 22, WIDTH = 0, HEIGHT = 0; // of the box
  const COLOURS = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
  let job = 0, now = null, cursor = null;

  function colour(share) {
    const at = Math.min(0.9999, Math.max(0, share)) * (COLOURS.length - 1), i = Math.floor(at);
    return `rgb(${COLOURS[i].map((c, k) => Math.round(c + (COLOURS[i + 1][k] - c) * (at - i))).join(",")})`;
  }

  /** The values of an input along a side of the map, around its value in the contact. */
  function axis(contact, name, wide) {
    const { value } = contact.inputs.v[name], [low, high] = Contact.INPUTS[name].range;
    if (name.startsWith("nu")) return { name, log: false, low: 0, high: 0.5, value };
    return { name, log: true, low: Math.max(Math.min(low, value), value / wide), high: Math.min(Math.max(high, value), value * wide), value };
  }
  const along = (axis, share) => (axis.log ? axis.low * (axis.high / axis.low) ** share : axis.low + (axis.high - axis.low) * share);
  const shareOf = (axis, value) => (axis.log ? Math.log(value / axis.low) / Math.log(axis.high / axis.low) : (value - axis.low) / (axis.high - axis.low));

  /** The texts of the contact with other numbers; a material becomes its numbers. */
  function moved(contact, numbers) {
    const texts = { ...contact.texts };
    for (const [body, own] of Object.entries(Contact.BODIES)) {
      if (!own.some((name) => name in numbers)) continue;
      for (const name of own) texts[name] = textOf(name, contact.inputs.v[name].value);
      keepStrength(texts, body);
      delete texts[body];
    }
    for (const [name, value] of Object.entries(numbers)) texts[name] = textOf(name, value);
    return texts;
  }

  /** The strength of the material of a body as a text of its own, or "". */
  function keepStrength(texts, body) {
    const name = Object.keys(Contact.STRENGTHS).find((own) => Contact.STRENGTHS[own].body === body), material = Contact.MATERIALS[texts[body]];
    if (material) texts[name] = material.Y ? textOf(name, material.Y) : "";
  }

  /** A number as it would be typed, with three or more digits. */
  function textOf(name, value, digits = 4) {
    const unit = (Contact.INPUTS[name] || Contact.STRENGTHS[name]).unit, rows = Contact.UNITS[unit].write, [word, size] = rows.find((row) => value >= row[1]) || rows[rows.length - 1];
    return `${Number((value / size).toPrecision(digits))} ${word.replace("µ", "u").replace("²", "^2")}`.trim();
  }

  /** Draw the map into `box`. take(texts): what a click or Enter does with the contact under the cursor. */
  function draw(box, contact, chosen, take) {
    const mine = ++job, axes = [axis(contact, chosen.x, chosen.wide), axis(contact, chosen.y, chosen.wide)];
    let canvas = box.querySelector("canvas");
    if (!canvas) {
      box.innerHTML = '<canvas tabindex="0" role="img"></canvas><p class="note" role="status"></p>';
      canvas = box.querySelector("canvas");
      canvas.addEventListener("mousemove", (event) => point(box, cellAt(canvas, event)));
      canvas.addEventListener("mouseleave", () => point(box, null));
      canvas.addEventListener("click", (event) => choose(cellAt(canvas, event)));
      canvas.addEventListener("keydown", (event) => keys(box, event));
    }
    CELL = Math.floor(2 * (Math.min(690, box.clientWidth) - LEFT - BAR) / SIDE) / 2;
    WIDTH = LEFT + SIDE * CELL + BAR;
    HEIGHT = TOP + SIDE * CELL + BELOW;
    canvas.width = WIDTH * 2;
    canvas.height = HEIGHT * 2;
    canvas.style.width = `${WIDTH}px`;
    now = { contact, chosen, axes, take, cells: Array(SIDE * SIDE).fill(null), canvas };
    cursor = null;
    let next = 0;
    const order = Array.from({ length: SIDE * SIDE }, (_, i) => i);
    function some() {
      if (mine !== job) return;
      const end = performance.now() + 10;
      while (next < order.length && performance.now() < end) {
        const i = order[next++], numbers = { [chosen.x]: along(axes[0], (i % SIDE + 0.5) / SIDE), [chosen.y]: along(axes[1], (Math.floor(i / SIDE) + 0.5) / SIDE) };
        const found = Contact.solve(moved(contact, numbers), true);
        const value = found.status === "converged" ? found.Q[chosen.of] : NaN;
        now.cells[i] = { value, beyond: (found.lights || []).filter((row) => row.state === "beyond").map((row) => row.title), status: found.status, numbers };
      }
      if (next === order.length) { paint(); said(box); box.ariaBusy = "false"; } else setTimeout(some, 0);
      if (next < order.length && next % 96 < 8) paint();
    }
    some();
  }

  function range() {
    const values = now.cells.filter((cell) => cell && Number.isFinite(cell.value)).map((cell) => cell.value);
    const low = Math.min(...values), high = Math.max(...values);
    return { low, high, log: low > 0 && high / low > 8, flat: !(high - low > 1e-9 * Math.abs(high)) };
  }

  function paint() {
    const { canvas, cells, axes, chosen } = now, g = canvas.getContext("2d"), style = getComputedStyle(document.documentElement);
    const ink = style.getPropertyValue("--ink"), soft = style.getPropertyValue("--soft"), side = SIDE * CELL, own = range();
    const share = (value) => (own.flat ? 0.5 : own.log ? Math.log(value / own.low) / Math.log(own.high / own.low) : (value - own.low) / (own.high - own.low));
    g.setTransform(2, 0, 0, 2, 0, 0);
    g.clearRect(0, 0, WIDTH, HEIGHT);
    g.font = "12px system-ui, 'Segoe UI', 'Liberation Sans', sans-serif";
    cells.forEach((cell, i) => {
      const x = LEFT + (i % SIDE) * CELL, y = TOP + side - (Math.floor(i / SIDE) + 1) * CELL;
      if (!cell) return;
      if (Number.isFinite(cell.value)) {
        g.fillStyle = colour(share(cell.value));
        g.fillRect(x, y, CELL + 0.5, CELL + 0.5);
      }
      if (cell.beyond.length || !Number.isFinite(cell.value)) hatch(g, x, y, Number.isFinite(cell.value) ? (share(cell.value) > 0.6 ? "#000" : "#fff") : soft);
    });
    g.strokeStyle = soft;
    g.lineWidth = 1;
    g.strokeRect(LEFT, TOP, side, side);
    const [x, y] = axes.map((one) => shareOf(one, one.value) * side);
    g.strokeStyle = "#fff"; g.lineWidth = 4; g.beginPath(); g.arc(LEFT + x, TOP + side - y, 6, 0, 7); g.stroke();
    g.strokeStyle = "#000"; g.lineWidth = 2; g.beginPath(); g.arc(LEFT + x, TOP + side - y, 6, 0, 7); g.stroke();
    g.fillStyle = ink;
    axes.forEach((one, which) => {
      const unit = Contact.INPUTS[one.name].unit, label = Contact.INPUTS[one.name].label;
      const skip = SIDE * CELL < 400 ? 2 : 1;
      for (let i = 0; i <= 4; i += which ? 1 : skip) {
        const words = Contact.readable(along(one, i / 4), unit, 2), at = side * i / 4;
        g.textAlign = which ? "right" : i === 4 ? "right" : i ? "center" : "left";
        g.fillText(words, which ? LEFT - 6 : LEFT + at, which ? TOP + side - at + (i === 4 ? 9 : 4) : TOP + side + 16);
      }
      if (!which) { g.textAlign = "center"; g.fillText(label, LEFT + side / 2, TOP + side + 36); } else {
        g.save(); g.translate(13, TOP + side / 2); g.rotate(-Math.PI / 2); g.textAlign = "center"; g.fillText(label, 0, 0); g.restore();
      }
    });
    const bar = LEFT + side + 16;
    for (let i = 0; i < 64; i++) { g.fillStyle = colour((i + 0.5) / 64); g.fillRect(bar, TOP + side * (1 - (i + 1) / 64), 14, side / 64 + 0.7); }
    g.fillStyle = ink;
    g.textAlign = "left";
    for (let i = 0; i <= 4 && Number.isFinite(own.low); i++) {
      const value = own.log ? own.low * (own.high / own.low) ** (i / 4) : own.low + (own.high - own.low) * i / 4;
      g.fillText(Contact.readable(value, Contact.RESULTS[chosen.of].unit, 3), bar + 19, TOP + side * (1 - i / 4) + (i === 4 ? 10 : i ? 4 : 0));
    }
    if (cursor !== null) {
      g.strokeStyle = "#fff"; g.lineWidth = 3;
      g.strokeRect(LEFT + (cursor % SIDE) * CELL, TOP + side - (Math.floor(cursor / SIDE) + 1) * CELL, CELL, CELL);
    }
    canvas.setAttribute("aria-label", `${Contact.RESULTS[chosen.of].label} over ${axes.map((one) => Contact.INPUTS[one.name].label).join(" and ")}; arrow keys move, Enter takes a contact.`);
  }

  function hatch(g, x, y, colourOf) {
    g.save();
    g.beginPath(); g.rect(x, y, CELL, CELL); g.clip();
    g.strokeStyle = colourOf; g.globalAlpha = 0.55; g.lineWidth = 1.2; g.beginPath();
    for (let k = -CELL; k <= CELL; k += CELL / 2) { g.moveTo(x + k, y + CELL); g.lineTo(x + k + CELL, y); }
    g.stroke();
    g.restore();
  }

  function said(box, cell) {
    const note = box.querySelector(".note"), { chosen, cells } = now, all = cells.filter(Boolean);
    if (!cell) {
      const hatched = all.filter((one) => one.beyond.length || !Number.isFinite(one.value)).length;
      note.textContent = `Circle: this contact. Hatched, ${Contact.percent(hatched / all.length)} of the map: an assumption of the model fails there, or the page has no solution. A click takes a contact.`;
      return;
    }
    const numbers = Object.entries(cell.numbers).map(([name, value]) => `${name} = ${Contact.readable(value, Contact.INPUTS[name].unit)}`).join(", ");
    const value = Number.isFinite(cell.value) ? Contact.readable(cell.value, Contact.RESULTS[chosen.of].unit) : `not solved (${cell.status})`;
    note.textContent = `${numbers}: ${Contact.RESULTS[chosen.of].symbol} = ${value}${cell.beyond.length ? `. Does not hold: ${cell.beyond.join("; ").toLowerCase()}` : ""}`;
  }

  function cellAt(canvas, event) {
    const box = canvas.getBoundingClientRect(), f = WIDTH / box.width;
    const column = Math.floor(((event.clientX - box.left) * f - LEFT) / CELL), row = SIDE - 1 - Math.floor(((event.clientY - box.top) * f - TOP) / CELL);
    return column >= 0 && column < SIDE && row >= 0 && row < SIDE ? row * SIDE + column : null;
  }
  function point(box, i) {
    cursor = i;
    paint();
    said(box, i === null ? null : now.cells[i]);
  }
  function choose(i) {
    if (i !== null && now.cells[i]) now.take(moved(now.contact, Object.fromEntries(Object.entries(now.cells[i].numbers).map(([name, value]) => [name, Number(value.toPrecision(3))]))));
  }
  function keys(box, event) {
    const move = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: SIDE, ArrowDown: -SIDE }[event.key];
    if (event.key === "Enter") choose(cursor);
    if (!move) return;
    event.preventDefault();
    const from = cursor ?? SIDE * SIDE / 2 + SIDE / 2, next = from + move, wraps = Math.abs(move) === 1 && Math.floor(next / SIDE) !== Math.floor(from / SIDE);
    point(box, next >= 0 && next < SIDE * SIDE && !wraps ? next : from);
  }

  /** The contact has changed: what is being drawn is of another, and nothing is taken from it. */
  function stop() {
    job++;
    now = now && { ...now, take: () => {} };
  }

  return { draw, stop, textOf, keepStrength, paint: () => now && paint() };
})(Contact, Drawing);

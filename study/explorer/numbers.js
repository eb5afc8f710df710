"use strict";
/* Numbers as texts: every number that the page reads or shows goes through here. */
const Numbers = (() => {
  /** SI unit -> spellings that are read, and the multiples in which numbers are written. */
  const UNITS = {
    m: { what: "a length", read: { m: 1, cm: 1e-2, mm: 1e-3, um: 1e-6, nm: 1e-9 }, write: [["m", 1], ["mm", 1e-3], ["µm", 1e-6], ["nm", 1e-9]] },
    N: { what: "a force", read: { MN: 1e6, kN: 1e3, N: 1, mN: 1e-3, uN: 1e-6, nN: 1e-9 }, write: [["kN", 1e3], ["N", 1], ["mN", 1e-3], ["µN", 1e-6], ["nN", 1e-9]] },
    Pa: { what: "a pressure", read: { TPa: 1e12, GPa: 1e9, MPa: 1e6, kPa: 1e3, Pa: 1 }, write: [["GPa", 1e9], ["MPa", 1e6], ["kPa", 1e3], ["Pa", 1]] },
    "1/m^2": { what: "a number per area", read: { "1/um^2": 1e12, "1/mm^2": 1e6, "1/cm^2": 1e4, "1/m^2": 1 }, write: [["1/µm²", 1e12], ["1/mm²", 1e6], ["1/m²", 1]] },
    "N/m": { write: [["MN/m", 1e6], ["kN/m", 1e3], ["N/m", 1], ["mN/m", 1e-3]] },
    1: { what: "a number", read: { "": 1 }, write: [["", 1]] },
  };

  const NUMBER = "[-+]?(?:\\d+\\.?\\d*|\\.\\d+)(?:[eE][-+]?\\d+)?";
  const QUANTITY = new RegExp(`^(${NUMBER})\\s*([^±+\\s]*)\\s*(?:(?:±|\\+/-|\\+-)\\s*(${NUMBER})\\s*(%?)\\s*(\\S*))?$`);

  /** {value, spread, word, size} in the SI `unit` of a text such as "5 mm", "200 ± 10 GPa", "2 um ± 5 %"; an Error with a message. */
  function parse(name, unit, text) {
    const { what, read } = UNITS[unit], example = Object.keys(read)[unit === "1" ? 0 : 2];
    const wanted = unit === "1" ? "must be a number without a unit" : `must be ${what} with its unit: ${Object.keys(read).join(", ")}`;
    const plain = String(text).trim().replace(/[µμ]/g, "u").replace(/²/g, "^2").replace(/−/g, "-"), found = QUANTITY.exec(plain);
    if (!found) throw Error(plain.includes(",") ? `${name}: write the number with a decimal point` : `${name} = "${text}": ${wanted}`);
    const [, number, first, more, percent, last] = found, word = first || last || "", other = last || first || "";
    if (!(word in read) || !(other in read)) throw Error(`${name} = "${text}": ${word || plain in read ? wanted : `${wanted}, such as ${number} ${example}`}`);
    if (first && more && (percent ? last : !last)) throw Error(`${name} = "${text}": write the spread as in "2 ± 0.1 ${first}" or "2 ${first} ± 5 %"`);
    const value = Number(number) * read[word];
    const spread = !more ? 0 : percent ? Math.abs(value) * Number(more) / 100 : Number(more) * read[other];
    if (spread < 0 || !Number.isFinite(value)) throw Error(`${name} = "${text}": ${wanted}`);
    return { value, spread, word, size: read[word] };
  }

  /** What is written for a value that is no number, or "" for one that is. */
  const word = (value) => (Number.isFinite(value) ? "" : Number.isNaN(value) ? "unknown" : value > 0 ? "infinite" : "minus infinite");

  /** The power of ten of a number that is written with so many digits: 0 of 9.4, 1 of 9.6 with one digit. */
  const power = (value, digits) => (value === 0 ? 0 : Number(value.toExponential(digits - 1).split("e")[1]));

  /** A number with at most so many digits, without a power of ten from 1e-6 up: 0.0001, 1.5, 100, 1500. */
  const short = (value, digits = 2) => word(value) || String(Number(value.toPrecision(digits)));

  /** A share, as 100 % of 0.997. */
  const percent = (share) => (Number.isFinite(share) ? `${short(100 * share)} %` : word(share));

  /** A share, or how many times the whole it is: 99 %, 1.0 times, 120 times. */
  function part(share) {
    if (!(share >= 1 && share < Infinity)) return percent(share);
    return `${share < 9.95 ? share.toPrecision(2) : share < 100 ? short(share) : Math.round(share)} times`;
  }

  /** How many there are: 0.12, 3, 12,000. */
  const count = (value) => (value >= 1 && value < 1e15 ? Number(value.toPrecision(2)).toLocaleString("en") : short(value));

  /** A number with so many places after the point; below 0, with so many zeros before it. */
  function rounded(value, places) {
    const text = places < 0 ? String(Math.round(value / 10 ** -places) * 10 ** -places)
      : places > 6 ? value.toExponential(Math.max(0, power(value, 1) + places)) : value.toFixed(places);
    return Number(text) === 0 ? text.replace("-", "") : text;
  }

  /** A number with at most four digits, in the multiple of its SI unit that suits it: {text, unit, whole}; `digits` are
      what its error allows, and ± has two digits at most. */
  function written(value, unit, digits = 4, spread = 0) {
    const rows = UNITS[unit].write, told = word(value);
    if (told) return { text: told, unit: "", whole: told };
    const about = Math.abs(Number(value.toPrecision(digits))), [name, size] = rows.find((row) => about >= row[1]) || rows[rows.length - 1];
    const number = value / size, own = spread / size, sure = !(own > 0 && own < Infinity);
    const places = Math.min(number === 0 ? (sure ? 0 : Infinity) : digits - 1 - power(number, digits), sure ? Infinity : 1 - power(own, 2));
    const more = sure ? "" : rounded(own, places), text = rounded(number, places) + (Number(more) > 0 ? ` ± ${more}` : "");
    return { text, unit: name, whole: `${text} ${name}`.trim() };
  }
  const readable = (value, unit, digits = 3) => written(value, unit, digits).whole;

  return { UNITS, parse, short, percent, part, count, written, readable };
})();
if (typeof module !== "undefined") module.exports = Numbers;

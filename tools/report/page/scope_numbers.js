// Numbers, units and their prefixes, as plots show them.
const PREFIXES = { "-15": "f", "-12": "p", "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T" };
// A unit takes a prefix if it begins with one of these to the first power.
const PREFIXABLE = /^(m|s|N|V|A|W|Hz|rad|J|Pa|F|H|Ω|T|C)(?=$|[\/·])/;
const SUPERSCRIPT = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** The power of ten, a multiple of 3, in which values up to `largest` are easy to read. */
export function exponentFor(largest, unit) {
  if (!(largest > 0) || !isFinite(largest)) return 0;
  const exponent = 3 * Math.floor(Math.log10(largest * 1.0000001) / 3);
  if (!PREFIXABLE.test(unit)) return largest < 1e-3 || largest >= 1e6 ? exponent : 0;
  const highest = /^(s|rad)/.test(unit) ? 0 : 12;  // kiloseconds are not in use
  return Math.max(-15, Math.min(highest, exponent));
}

export const superscript = (n) => String(n).replace("-", "⁻").replace(/\d/g, (d) => SUPERSCRIPT[d]);

/** Unit with its prefix, or after a power of ten: "µm", "×10⁻⁶ V·s". */
export function scaledUnit(exponent, unit) {
  if (exponent === 0) return unit;
  if (PREFIXABLE.test(unit)) return PREFIXES[exponent] + unit;
  return `×10${superscript(exponent)}${unit ? " " + unit : ""}`;
}

export const withMinus = (text) => text.replace("-", "−");

/** Number of decimals that distinguishes multiples of `step`. */
export function decimalsFor(step) {
  for (let decimals = 0; decimals < 15; ++decimals) {
    const scaled = step * 10 ** decimals;
    if (Math.abs(scaled - Math.round(scaled)) < 1e-3 * scaled) return decimals;
  }
  return 15;
}

/** One value at the cursor, five significant digits. */
export function readOut(value, unit) {
  const exponent = exponentFor(Math.abs(value), unit);
  const scaled = value / 10 ** exponent;
  const text = scaled === 0 ? "0" : Math.abs(scaled) >= 1e5 ? scaled.toFixed(0) : String(+scaled.toPrecision(5));
  const shown = scaledUnit(exponent, unit);
  return withMinus(text) + (shown ? "\u202f" + shown : "");
}

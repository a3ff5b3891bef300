// Numbers and units as people read them: "250 µm" for 2.5e-4 m. Values are in SI.

const PREFIXES: Record<number, string> =
  { [-15]: "f", [-12]: "p", [-9]: "n", [-6]: "µ", [-3]: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T" };
/** A unit takes a prefix if it begins with one of these to the first power. */
const PREFIXABLE = /^(m|s|N|V|A|W|Hz|rad|J|Pa|F|H|Ω|T|C)(?=$|[/·*])/;
const SUPERSCRIPT = "⁰¹²³⁴⁵⁶⁷⁸⁹";
const NARROW_SPACE = "\u202f";

/** The power of ten, a multiple of 3, in which values up to `largest` are easy to read. */
export function exponentFor(largest: number, unit: string): number {
  if (!(largest > 0) || !isFinite(largest)) return 0;
  const exponent = 3 * Math.floor(Math.log10(largest * 1.0000001) / 3);
  if (!PREFIXABLE.test(unit)) return largest < 1e-3 || largest >= 1e6 ? exponent : 0;
  const highest = /^(s|rad)/.test(unit) ? 0 : 12;  // kiloseconds are not in use
  return Math.max(-15, Math.min(highest, exponent));
}

export const superscript = (n: number | string): string =>
  String(n).replace("-", "⁻").replace(/\d/g, (digit) => SUPERSCRIPT[Number(digit)] ?? digit);

/** "N*s^2/m" as "N·s²/m". */
export const prettyUnit = (unit: string): string =>
  unit === "1" ? "" : unit.replace(/\*/g, "·").replace(/\^(-?\d+)/g, (_, power: string) => superscript(power));

/** Unit with its prefix, or after a power of ten: "µm", "×10⁻⁶ V·s". */
export function scaledUnit(exponent: number, unit: string): string {
  const shown = prettyUnit(unit);
  if (exponent === 0) return shown;
  if (PREFIXABLE.test(unit)) return PREFIXES[exponent] + shown;
  return `×10${superscript(exponent)}${shown ? " " + shown : ""}`;
}

export const withMinus = (text: string): string => text.replace("-", "−");

/** Number of decimals that distinguishes multiples of `step`. */
export function decimalsFor(step: number): number {
  for (let decimals = 0; decimals < 15; ++decimals) {
    const scaled = step * 10 ** decimals;
    if (Math.abs(scaled - Math.round(scaled)) < 1e-3 * scaled) return decimals;
  }
  return 15;
}

/** One value with its unit. */
export function quantity(value: number | null | undefined, unit: string, digits = 4): string {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!isFinite(value)) return value > 0 ? "∞" : "−∞";
  const exponent = exponentFor(Math.abs(value), unit);
  const scaled = value / 10 ** exponent;
  const text = scaled === 0 ? "0" : Math.abs(scaled) >= 1e5 ? scaled.toFixed(0) : String(+scaled.toPrecision(digits));
  const shown = scaledUnit(exponent, unit);
  return withMinus(text) + (shown ? NARROW_SPACE + shown : "");
}

/** As the program writes it: "2.35 %", "1971 %". */
export const percent = (value: number): string => `${value >= 100 ? value.toFixed(0) : +value.toPrecision(3)} %`;

/** A plain number without a unit, short. */
export function short(value: number, digits = 4): string {
  if (!isFinite(value)) return value > 0 ? "∞" : value < 0 ? "−∞" : "NaN";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) {
    const power = Math.floor(Math.log10(size));
    const mantissa = +(value / 10 ** power).toPrecision(digits);
    return withMinus((mantissa === 1 ? "" : mantissa === -1 ? "-" : mantissa + "·") + "10" + superscript(power));
  }
  return withMinus(String(+value.toPrecision(digits)));
}

// What every request about the open diagram says: which file, with which numbers and variants. One place for all, so that no
// answer is about other numbers than those of the sliders.
import { get } from "./store";

/** The members of a request about the document that is open. */
export function about_document(more: object = {}): { path: string; set: Record<string, string>; variants: Record<string, string> } {
  const { document, overrides, variants } = get();
  return { path: document?.path ?? "", set: overrides, variants, ...more };
}

/** "mass = 0.3 kg, cutoff = 40 Hz" */
export const settings_text = (set: Record<string, string>): string => Object.entries(set).map(([name, value]) => `${name} = ${value}`).join(", ");

/** A number with its unit, as a request sets it. */
export const with_unit = (value: number, unit: string): string => (unit && unit !== "1" ? `${value} ${unit}` : String(value));

// Parameters that a fit refines: chosen beside their sliders, fitted as a job, written as one step of undo.
import type { EditAnswer, FitAnswer } from "../protocol/types";
import { change_by_program } from "./document";
import { about_document } from "./request";
import { attempt, start } from "./session";
import { get, patch } from "./store";

export function choose_for_fit(set: string, chosen: boolean): void {
  const others = get().fit_chosen.filter((entry) => entry !== set);
  patch({ fit_chosen: chosen ? [...others, set] : others });
}

export async function fit(): Promise<void> {
  const { experiment, fit_chosen, document } = get();
  if (!experiment || !fit_chosen.length || !document) return;
  patch({ fit: null, panel: "measure" });
  const answer = await attempt(start<FitAnswer>("fit", "fit", "Fitting", about_document({ experiments: [experiment], parameters: fit_chosen, lane: "fit" })).answer);
  if (answer && get().document?.path === document.path) patch({ fit: answer });
}

/** Writes the values. The numbers of their sliders are those of the file then. */
export async function write_fit(): Promise<EditAnswer | null> {
  const { fit: found, document } = get();
  if (!found || !document) return null;
  const answer = await change_by_program("write_fit", { path: document.path, fit: found.fit });
  if (!answer) return null;
  const written = new Set(found.parameters.map((entry) => entry.name));
  patch({ fit: null, overrides: Object.fromEntries(Object.entries(get().overrides).filter(([set]) => !written.has(set))) });
  return answer;
}

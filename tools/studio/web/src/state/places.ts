// Leads to a place of the diagram.
import { open } from "./document";
import { get, patch } from "./store";

/** Selects a block by its path, "stage.motor"; enters the level that it is on. */
export async function jump_to_block(path: string): Promise<void> {
  const dot = path.lastIndexOf("."), inside = dot < 0 ? "" : path.slice(0, dot), name = path.slice(dot + 1);
  if (inside !== get().inside && get().document) await open(get().document!.path, inside);
  if (get().document?.view?.blocks.some((block) => block.name === name)) patch({ selected: [name], selected_wire: "", place: "diagram" });
}

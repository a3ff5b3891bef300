// The program does not send again what a page already has of a view: it is put in here, as the same objects.
import type { Block, View, WireEntry } from "./types";

/** A block that is as it was sent before stands there by its name; wires that are as they were are null. */
type SentView = Omit<View, "blocks" | "wires"> & { blocks: (Block | string)[]; wires: WireEntry[] | null };
interface SentDocument { path?: string; view?: SentView | null }
interface Message { ok?: unknown; document?: SentDocument }

export class Views {
  private readonly known = new Map<string, View>();  // by the path of the file, as last sent

  /** Completes the views in a message. False if what it refers to never came. */
  complete(message: object): boolean {
    const { ok, document } = message as Message;
    const answer = ok as (SentDocument & { document?: SentDocument }) | undefined;
    return [document, answer, answer?.document].every((sent) => !sent?.view || !sent.path || this.put_in(sent.path, sent.view));
  }

  private put_in(path: string, view: SentView): boolean {
    const before = this.known.get(path), blocks = new Map(before?.blocks.map((block) => [block.name, block]));
    view.blocks = view.blocks.map((block) => (typeof block === "string" ? blocks.get(block) ?? block : block));
    view.wires ??= before?.wires ?? null;
    if (view.wires === null || view.blocks.some((block) => typeof block === "string")) return false;
    this.known.set(path, view as View);
    return true;
  }
}

// The connection of this page, and what every action needs of it.
import { Connection, Disconnected, Dropped, type Job } from "../protocol/connection";
import type { Document, FileEntry } from "../protocol/types";
import { get, patch, tell } from "./store";

let connection: Connection | null = null;

export function connect(hear: { open: () => void; document: (document: Document) => void }): void {
  connection = new Connection(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/socket`, {
    open: () => { patch({ connection: "open" }); hear.open(); },
    lost: () => patch({ connection: "lost", busy: {} }),
    event: (message) => {
      if (message["event"] === "document") hear.document(message["document"] as Document);
      if (message["event"] === "files") patch({ files: message["files"] as FileEntry[] });
    },
  });
}

export const ask = <T,>(what: string, members: object = {}): Promise<T> => connection!.ask<T>(what, members);

/** Starts a long job that is shown as under way until it ends. */
export function start<T, P = unknown>(key: string, what: string, title: string, members: object, partial?: (partial: P) => void): Job<T> {
  const job = connection!.start<T, P>(what, members, {
    progress: ({ stage, done }) => {
      const busy = get().busy[key];
      if (busy) patch({ busy: { ...get().busy, [key]: { ...busy, stage, done } } });
    },
    ...(partial ? { partial } : {}),
  });
  const mine = { what: title, stage: "", done: null, cancel: job.cancel };
  patch({ busy: { ...get().busy, [key]: mine } });
  const end = () => {
    if (get().busy[key]?.cancel !== mine.cancel) return;
    const { [key]: _ended, ...others } = get().busy;
    patch({ busy: others });
  };
  job.answer.then(end, end);
  return job;
}

/** Runs an action; what goes wrong is told to the user. Nothing for what was dropped. */
export async function attempt<T>(action: Promise<T>): Promise<T | null> {
  try {
    return await action;
  } catch (error) {
    if (error instanceof Dropped) return null;
    if (error instanceof Disconnected) { patch({ connection: "lost" }); return null; }
    tell("error", error instanceof Error ? error.message : String(error));
    return null;
  }
}

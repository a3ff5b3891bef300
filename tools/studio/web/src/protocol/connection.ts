// One WebSocket to the program: requests with their answers, progress and events. Reconnects by itself.
import { Views } from "./views";
import type { Problem } from "./types";

/** The program refused a request; `message` is what the command line would print. `consent`: it waits for the user to agree. */
export class Refused extends Error {
  constructor(message: string, readonly problems: Problem[], readonly consent = false) { super(message); }
}
/** Cancelled, or overtaken by a later request of the same lane. Not an error: nobody waits for the answer any more. */
export class Dropped extends Error {}
/** The connection ended before the answer came. */
export class Disconnected extends Error {}

export interface Progress { stage: string; done: number }

interface Waiting {
  resolve: (answer: never) => void;
  reject: (error: Error) => void;
  progress?: (progress: Progress) => void;
  partial?: (partial: never) => void;
}
interface Message {
  id?: number; ok?: unknown; error?: { text: string; problems?: Problem[]; consent?: boolean }; dropped?: boolean;
  progress?: Progress; partial?: unknown; event?: string;
}
export interface Job<T> { answer: Promise<T>; cancel: () => void }

const FIRST_PAUSE = 400, LONGEST_PAUSE = 5000;  // ms before the next attempt to connect

export class Connection {
  private socket: WebSocket | null = null;
  private last_id = 0;
  private readonly waiting = new Map<number, Waiting>();
  private pause = FIRST_PAUSE;
  private views = new Views();

  constructor(private readonly url: string, private readonly hear: {
    open: () => void; lost: () => void; event: (message: Record<string, unknown>) => void;
  }) {
    this.connect();
  }

  private connect() {
    const socket = new WebSocket(this.url);
    this.socket = socket;
    this.views = new Views();
    socket.onopen = () => { this.pause = FIRST_PAUSE; this.hear.open(); };
    socket.onmessage = (event) => {
      const message = JSON.parse(String(event.data)) as Message;
      // Should page and program differ about what was sent, a new connection begins with everything.
      if (this.views.complete(message)) this.receive(message); else socket.close();
    };
    socket.onclose = () => {
      for (const request of this.waiting.values()) request.reject(new Disconnected("The connection to the program was lost."));
      this.waiting.clear();
      this.hear.lost();
      setTimeout(() => this.connect(), this.pause);
      this.pause = Math.min(2 * this.pause, LONGEST_PAUSE);
    };
  }

  private receive(message: Message) {
    if (message.event !== undefined) { this.hear.event(message as Record<string, unknown>); return; }
    const request = this.waiting.get(message.id ?? -1);
    if (!request) return;
    if (message.progress) { request.progress?.(message.progress); return; }
    if (message.partial !== undefined) { request.partial?.(message.partial as never); return; }
    this.waiting.delete(message.id!);
    if (message.dropped) request.reject(new Dropped("dropped"));
    else if (message.error) request.reject(new Refused(message.error.text, message.error.problems ?? [], message.error.consent));
    else request.resolve(message.ok as never);
  }

  /** A long job: it can be cancelled and may report on its way. */
  start<T, P = unknown>(what: string, members: object = {}, report: { progress?: (p: Progress) => void; partial?: (p: P) => void } = {}): Job<T> {
    const id = ++this.last_id;
    const answer = new Promise<T>((resolve, reject) => {
      if (this.socket?.readyState !== WebSocket.OPEN) { reject(new Disconnected("There is no connection to the program.")); return; }
      this.waiting.set(id, { resolve: resolve as (answer: never) => void, reject, ...report } as Waiting);
      this.socket.send(JSON.stringify({ id, do: what, ...members }));
    });
    const cancel = () => {
      if (this.waiting.has(id) && this.socket?.readyState === WebSocket.OPEN)
        this.socket.send(JSON.stringify({ id: ++this.last_id, do: "cancel", job: id }));
    };
    return { answer, cancel };
  }

  ask<T>(what: string, members: object = {}): Promise<T> { return this.start<T>(what, members).answer; }
}

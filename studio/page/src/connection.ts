import { type Binary, CallFailed, kOtherVersion, kSubprotocol, type Problem, readBinary } from "./protocol";


interface TextMessage {
  id?: number;
  result?: unknown;
  errors?: Problem[];
  progress?: { done: number; total: number };
  event?: string;
  content?: unknown;
}

interface Running {
  done(result: unknown): void;
  failed(error: Error): void;
  progress?(done: number, total: number): void;
}

export interface CallOptions {
  progress?(done: number, total: number): void;
  signal?: AbortSignal;
}

/** The WebSocket to the program that serves the page. */
export class Connection {
  private readonly socket: WebSocket;
  private readonly calls = new Map<number, Running>();
  private readonly turns = new Map<number, Promise<unknown>>(); // the last call of each stage
  private readonly stages = new Map<number, (message: Binary) => void>();
  private readonly events = new Map<string, (content: unknown) => void>();
  private readonly page = crypto.getRandomValues(new Uint32Array(4)).join("-"); // by which the program knows with whom an upload goes
  private next = 1;
  onUnreadable: (problem: string) => void = () => {}; // a message that was left out

  /** `onClose` gets the program's words if it speaks another version of the protocol. */
  constructor(private readonly token: string, onOpen: () => void, onClose: (otherVersion: string) => void) {
    this.socket = new WebSocket(`${location.protocol.replace("http", "ws")}//${location.host}/socket`, [kSubprotocol, `token.${token}`, `page.${this.page}`]);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = onOpen;
    this.socket.onclose = ({ code, reason }) => {
      for (const call of this.calls.values()) call.failed(new Error("the studio has ended"));
      this.calls.clear();
      onClose(code === kOtherVersion ? reason : "");
    };
    this.socket.onmessage = (message) => this.take(message.data as string | ArrayBuffer);
  }

  /** Calls the program; rejects with CallFailed if it refuses. */
  call<T>(name: string, params: object = {}, options: CallOptions = {}): Promise<T> {
    const id = this.next++;
    return new Promise<T>((resolve, reject) => {
      this.calls.set(id, { done: (result) => resolve(result as T), failed: reject, progress: options.progress });
      options.signal?.addEventListener("abort", () => this.send({ cancel: id }));
      this.send({ id, call: name, params });
    });
  }

  /** The same for what opens and closes a stage, one after the other: the program runs calls side by side. `isWanted` is
      asked when it is the call's turn; null: it was not. */
  callInTurn<T>(stage: number, name: string, params: object, isWanted: () => boolean = () => true, options: CallOptions = {}): Promise<T | null> {
    const go = async () => (isWanted() ? this.call<T>(name, { ...params, stage }, options) : null);
    const turn = (this.turns.get(stage) ?? Promise.resolve()).then(go, go);
    this.turns.set(stage, turn);
    return turn;
  }

  /** A message that has no answer. */
  send(message: object): void {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  onStage(stage: number, take: (message: Binary) => void): void {
    this.stages.set(stage, take);
  }

  onEvent(name: string, take: (content: unknown) => void): void {
    this.events.set(name, take);
  }

  /** Stores a file of this machine below the folder. `progress` in [0, 1]. */
  upload(name: string, file: Blob, progress: (share: number) => void, signal: AbortSignal): Promise<void> {
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest();
      request.open("PUT", `/upload/${encodeURIComponent(name)}`);
      request.setRequestHeader("Authorization", `Bearer ${this.token}`);
      request.setRequestHeader("Content-Type", "application/octet-stream");
      request.setRequestHeader("Ctpm-Page", this.page);
      request.upload.onprogress = (event) => progress(event.total ? event.loaded / event.total : 0);
      request.onload = () => {
        if (request.status === 201) return resolve();
        const answer = JSON.parse(request.responseText) as { errors: Problem[] };
        reject(new CallFailed(answer.errors, request.status === 409));
      };
      request.onerror = () => reject(new Error("the upload broke off"));
      request.onabort = () => reject(new Error("stopped"));
      signal.addEventListener("abort", () => request.abort());
      request.send(file);
    });
  }

  /** Removes again what was uploaded. */
  async removeUpload(name: string): Promise<void> {
    await this.ask("DELETE", `/upload/${encodeURIComponent(name)}`);
  }

  /** A film that an export has written. */
  async film(path: string): Promise<Blob> {
    return (await this.ask("GET", `/film/${encodeURIComponent(path)}`)).blob();
  }

  private async ask(method: string, target: string): Promise<Response> {
    const response = await fetch(target, { method, headers: { Authorization: `Bearer ${this.token}` } });
    if (!response.ok) throw new CallFailed(((await response.json()) as { errors: Problem[] }).errors);
    return response;
  }

  /** A message; null: it cannot be read. */
  private read(data: string | ArrayBuffer): Binary | TextMessage | null {
    try {
      if (typeof data !== "string") return readBinary(data);
      const message: unknown = JSON.parse(data);
      if (typeof message !== "object" || message === null || "kind" in message) throw new RangeError("a text that is no message");
      return message as TextMessage;
    } catch (problem) {
      this.onUnreadable((problem as Error).message);
      return null;
    }
  }

  private take(data: string | ArrayBuffer): void {
    const message = this.read(data);
    if (!message) return;
    if ("kind" in message) return this.stages.get(message.stage)?.(message);
    if (message.event !== undefined) return this.events.get(message.event)?.(message.content);
    const call = message.id === undefined ? undefined : this.calls.get(message.id);
    if (!call || message.id === undefined) return;
    if (message.progress) return call.progress?.(message.progress.done, message.progress.total);
    this.calls.delete(message.id);
    if (message.errors) call.failed(new CallFailed(message.errors));
    else call.done(message.result);
  }
}

const kTokenKey = "ctpm.token";

/** The token of the address, or of this address before; it is taken out of what the address bar shows. */
export function takeToken(): string {
  const given = new URLSearchParams(location.hash.slice(1));
  const token = given.get("token");
  if (token) {
    localStorage.setItem(kTokenKey, token);
    given.delete("token");
    history.replaceState(null, "", `#${given.toString()}`);
  }
  return token ?? localStorage.getItem(kTokenKey) ?? "";
}

/** Calls `take` with a token that this page, or another one of this address, is given: that of the program's next run. */
export function onNewToken(take: (token: string) => void): () => void {
  const listen = (event: StorageEvent) => {
    if (event.key === kTokenKey && event.newValue) take(event.newValue);
  };
  const look = () => {
    if (new URLSearchParams(location.hash.slice(1)).has("token")) take(takeToken());
  };
  addEventListener("storage", listen), addEventListener("hashchange", look);
  return () => (removeEventListener("storage", listen), removeEventListener("hashchange", look));
}

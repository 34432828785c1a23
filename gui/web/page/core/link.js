/**
 * The one connection to the server (docs/web-protocol.md): says hello, hands frames to those who asked for their kind,
 * matches answers with calls, notices a dead network, and connects again.
 */

import { decode } from "../vendor/msgpack/decode.mjs";
import { encode } from "../vendor/msgpack/encode.mjs";

const PING_MS = 1000;
const SILENT_PINGS = 3; // without any frame since so many pings the network counts as lost; not by the clock, which a busy page misses
const RETRY_MS = [300, 700, 1500, 3000];

/** Close codes after which trying again makes no sense until somebody acts. */
const TOKEN_WRONG = 4401;
const ORIGIN_WRONG = 4403;

/** What the server answered instead of a result. */
export class CallError extends Error {
  /** @param {string} code @param {string} text @param {Record<string, any>} [details] */
  constructor(code, text, details = {}) {
    super(text);
    this.code = code;
    this.details = details;
  }
}

/**
 * For a question that is asked again and again: answers may overtake each other, and only that to the newest one counts.
 * @returns {() => () => boolean} called with each question; what it gives says whether no newer one has been asked
 */
export function turns() {
  let newest = 0;
  return () => {
    newest += 1;
    const mine = newest;
    return () => mine === newest;
  };
}

/** @typedef {(frame: any) => void} Listener */

export class Link {
  /** @type {WebSocket | null} */
  #socket = null;
  /** @type {Map<number, {resolve: (value: any) => void, reject: (error: Error) => void}>} */
  #calls = new Map();
  /** @type {Map<string, Set<Listener>>} */
  #listeners = new Map();
  #serial = 0;
  #retries = 0;
  #unanswered = 0;
  #open = false;

  /** @param {() => {token: string | null, name: string, lang: string}} introduction asked for at each connection */
  constructor(introduction) {
    this.introduction = introduction;
    setInterval(() => this.#ping(), PING_MS);
  }

  get open() {
    return this.#open;
  }

  connect() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/ws`);
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    this.#unanswered = 0;
    socket.onopen = () => this.#send({ t: "hello", ...this.introduction() });
    socket.onmessage = (event) => this.#take(event.data);
    socket.onclose = (event) => this.#closed(socket, event.code, event.reason);
  }

  /**
   * Hear every frame of one kind; `open` and `close` are the link's own.
   * @param {string} kind @param {Listener} listener @returns {() => void} ends it
   */
  on(kind, listener) {
    if (!this.#listeners.has(kind)) this.#listeners.set(kind, new Set());
    this.#listeners.get(kind)?.add(listener);
    return () => this.#listeners.get(kind)?.delete(listener);
  }

  /**
   * Call a method of the server.
   * @param {string} method @param {Record<string, any>} [args]
   * @returns {Promise<any>} its value; rejects with a CallError
   */
  call(method, args = {}) {
    if (!this.#open) return Promise.reject(new CallError("link", "no connection to the machine"));
    this.#serial += 1;
    const id = this.#serial;
    return new Promise((resolve, reject) => {
      this.#calls.set(id, { resolve, reject });
      this.#send({ t: "call", id, m: method, a: args });
    });
  }

  /** Say that the button of a jog is still held. @param {number} jog */
  beat(jog) {
    if (this.#open) this.#send({ t: "beat", jog });
  }

  /** End this connection and make a new one, with a new introduction. */
  again() {
    this.#retries = 0;
    if (this.#socket && this.#socket.readyState <= WebSocket.OPEN) this.#socket.close(1000);
    else this.connect();
  }

  /** @param {any} frame */
  #send(frame) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(encode(frame));
  }

  /** @param {ArrayBuffer} data */
  #take(data) {
    this.#unanswered = 0;
    const frame = /** @type {any} */ (decode(data));
    if (frame.t === "result" || frame.t === "error") this.#answer(frame);
    else if (frame.t === "hello") {
      this.#open = true;
      this.#retries = 0;
    }
    this.#tell(frame.t, frame);
  }

  /** @param {any} frame */
  #answer(frame) {
    const call = this.#calls.get(frame.id);
    this.#calls.delete(frame.id);
    if (frame.t === "result") call?.resolve(frame.ok);
    else call?.reject(new CallError(frame.code, frame.text, frame));
  }

  /** @param {string} kind @param {any} frame */
  #tell(kind, frame) {
    for (const listener of [...(this.#listeners.get(kind) ?? [])]) {
      try {
        listener(frame);
      } catch (error) {
        console.error(error); // one listener's mistake must not stop the others
      }
    }
  }

  #ping() {
    if (this.#socket?.readyState !== WebSocket.OPEN) return;
    if (this.#unanswered >= SILENT_PINGS) {
      // close() would wait for an answer that a dead network never brings.
      this.#closed(this.#socket, 1006, "");
      return;
    }
    this.#unanswered += 1;
    this.#send({ t: "ping", id: 0 });
  }

  /** @param {WebSocket} socket @param {number} code @param {string} reason */
  #closed(socket, code, reason) {
    if (socket !== this.#socket) return;
    socket.onclose = socket.onmessage = null;
    socket.close();
    this.#socket = null;
    this.#open = false;
    for (const call of this.#calls.values()) call.reject(new CallError("link", "the connection to the machine was lost"));
    this.#calls.clear();
    this.#tell("close", { code, reason, final: code === TOKEN_WRONG || code === ORIGIN_WRONG });
    if (code === TOKEN_WRONG || code === ORIGIN_WRONG) return;
    const pause = RETRY_MS[Math.min(this.#retries, RETRY_MS.length - 1)];
    this.#retries += 1;
    setTimeout(() => this.#socket ?? this.connect(), pause);
  }
}

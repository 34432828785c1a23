/**
 * Where the picture shows a pose of nine axes: [DISPLAY]GEOMETRY as `config.geometry` has it. Each part of it is one point:
 * steps, carried out one after the other, that move the point along X, Y or Z or turn it about them. Most machines have
 * one part; a foam cutter has two, the ends of its wire, each in a plane of its own.
 */

import { AXES as COUNT, startOf } from "./data.js";

const LETTERS = "XYZABCUVW";
const ROTARY = 1; // index of the kind: linear, rotary, second linear
const DEGREES_OF_A_CHORD = 5; // what turns is drawn as chords of an arc

/** @typedef {{steps: [string, number][], height: number}} Part letters with their signs; machine units */
/** @typedef {{kind: number, axis: number, index: number, sign: number}} Step */
/** @typedef {import("./data.js").Chunk} Chunk */

export class Shape {
  /** @type {{steps: Step[], height: number}[]} */
  #parts;
  /** @type {number[]} indexes of the rotary axes that turn something */
  #turning;
  #radians;

  /** @param {Part[]} parts @param {number} degreesPerUnit */
  constructor(parts, degreesPerUnit) {
    this.#radians = (degreesPerUnit * Math.PI) / 180;
    this.#parts = parts.map(({ steps, height }) => ({ height, steps: steps.map(([letter, sign]) => stepOf(LETTERS.indexOf(letter), sign)) }));
    this.#turning = [...new Set(this.#parts.flatMap((part) => part.steps.filter((step) => step.kind === ROTARY).map((step) => step.index)))];
  }

  /** How many points a pose is shown as. */
  get points() {
    return this.#parts.length;
  }

  /**
   * Write the point that one part makes of a pose.
   * @param {number[] | Float32Array} out @param {number} at @param {number} part
   * @param {ArrayLike<number>} pose @param {number} [from] where its nine numbers begin
   */
  place(out, at, part, pose, from = 0) {
    const { steps, height } = this.#parts[part];
    const point = [0, 0, 0];
    for (const { kind, axis, index, sign } of steps) {
      const value = sign * pose[from + index];
      if (kind === ROTARY) turn(point, axis, value * this.#radians);
      else point[axis] += value;
    }
    out[at] = point[0];
    out[at + 1] = point[1];
    out[at + 2] = point[2] + height;
  }

  /** All points of a pose. @param {ArrayLike<number>} pose @returns {number[][]} */
  pointsOf(pose) {
    return this.#parts.map((_part, number) => {
      const point = [0, 0, 0];
      this.place(point, 0, number, pose);
      return point;
    });
  }

  /** How many segments a move is drawn as. @param {Chunk} chunk @param {number} n */
  segments(chunk, n) {
    return this.#chords(startOf(chunk, n), chunk, n) * this.#parts.length;
  }

  /** Write the ends of each segment of a move; six numbers each. @param {number[] | Float32Array} positions @param {number} at @param {Chunk} chunk @param {number} n */
  put(positions, at, chunk, n) {
    const start = startOf(chunk, n);
    const chords = this.#chords(start, chunk, n);
    const pose = new Array(COUNT);
    const between = (/** @type {number} */ share) => {
      for (let axis = 0; axis < COUNT; axis += 1) pose[axis] = start[axis] + share * (chunk.end[n * COUNT + axis] - start[axis]);
      return pose;
    };
    for (let part = 0; part < this.#parts.length; part += 1) {
      for (let chord = 0; chord < chords; chord += 1, at += 6) {
        this.place(positions, at, part, between(chord / chords));
        this.place(positions, at + 3, part, between((chord + 1) / chords));
      }
    }
  }

  /** @param {ArrayLike<number>} start @param {Chunk} chunk @param {number} n */
  #chords(start, chunk, n) {
    let most = 0;
    for (const index of this.#turning) most = Math.max(most, Math.abs(chunk.end[n * COUNT + index] - start[index]));
    return Math.max(1, Math.ceil((most * this.#radians * 180) / Math.PI / DEGREES_OF_A_CHORD));
  }
}

/** @param {number} index of the letter @param {number} sign @returns {Step} */
function stepOf(index, sign) {
  return { kind: Math.floor(index / 3), axis: index % 3, index, sign };
}

/** Turn a point about X, Y or Z. @param {number[]} point @param {number} axis @param {number} angle radians */
function turn(point, axis, angle) {
  const [one, other] = [(axis + 1) % 3, (axis + 2) % 3];
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  [point[one], point[other]] = [point[one] * cos - point[other] * sin, point[one] * sin + point[other] * cos];
}

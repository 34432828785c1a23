/** The moves of the loaded program as they arrive in `path` frames, and the forecast's times: plain arrays, no drawing. */

export const KIND = Object.freeze({ RAPID: 0, FEED: 1, ARC: 2, PROBE: 3, JUMP: 4 });
export const AXES = 9;

/**
 * @typedef {object} Chunk
 * @property {number} first number of its first move
 * @property {number} count
 * @property {Float32Array} start point before its first move, nine numbers
 * @property {Float32Array} end nine numbers for each move
 * @property {Uint32Array} line @property {Uint8Array} kind @property {Float32Array} feed @property {Uint16Array} tool
 */

/** A msgpack binary as a typed array; it may lie anywhere in its frame, so it is copied. @param {Uint8Array} bytes */
const buffer = (bytes) => bytes.slice().buffer;

export class PathData {
  /** @type {Chunk[]} */
  chunks = [];
  job = 0;
  /** @type {any} the `path_end` frame, null until it came */
  end = null;
  /** @type {{lines: Uint32Array, times: Float32Array, seconds: number, sections: any[]} | null} */
  forecast = null;
  feedRange = [Infinity, 0];

  /** @param {number} job */
  begin(job) {
    this.job = job;
    this.chunks = [];
    this.end = null;
    this.forecast = null;
    this.feedRange = [Infinity, 0];
  }

  /** @param {any} frame a `path` frame @returns {Chunk} */
  add(frame) {
    const end = new Float32Array(buffer(frame.end));
    const last = this.chunks.at(-1);
    const chunk = {
      first: frame.first,
      count: frame.count,
      start: last ? last.end.subarray((last.count - 1) * AXES, last.count * AXES) : end.subarray(0, AXES),
      end,
      line: new Uint32Array(buffer(frame.line)),
      kind: new Uint8Array(buffer(frame.kind)),
      feed: new Float32Array(buffer(frame.feed)),
      tool: new Uint16Array(buffer(frame.tool)),
    };
    this.chunks.push(chunk);
    for (let n = 0; n < chunk.count; n += 1) {
      if (chunk.kind[n] === KIND.RAPID || chunk.kind[n] === KIND.JUMP || !(chunk.feed[n] > 0)) continue;
      if (chunk.feed[n] < this.feedRange[0]) this.feedRange[0] = chunk.feed[n];
      if (chunk.feed[n] > this.feedRange[1]) this.feedRange[1] = chunk.feed[n];
    }
    return chunk;
  }

  /** @param {any} frame a `forecast` frame */
  addForecast(frame) {
    this.forecast = null;
    if (!(frame.seconds > 0)) return; // nothing that takes time, or no forecast at all
    this.forecast = {
      lines: new Uint32Array(buffer(frame.lines)),
      times: new Float32Array(buffer(frame.times)),
      seconds: frame.seconds,
      sections: frame.sections ?? [],
    };
  }

  get moves() {
    const last = this.chunks.at(-1);
    return last ? last.first + last.count : 0;
  }

  /** The move of a number, or null. @param {number} number @returns {{chunk: Chunk, n: number} | null} */
  move(number) {
    const chunk = this.chunks.find((one) => number >= one.first && number < one.first + one.count);
    return chunk ? { chunk, n: number - chunk.first } : null;
  }

  /** Visit each move of these lines. @param {(line: number) => boolean} wanted @param {(chunk: Chunk, n: number) => void} visit */
  forLines(wanted, visit) {
    for (const chunk of this.chunks) {
      for (let n = 0; n < chunk.count; n += 1) if (chunk.kind[n] !== KIND.JUMP && wanted(chunk.line[n])) visit(chunk, n);
    }
  }

  /** Least and greatest coordinates of the points that are shown. @param {import("./shape.js").Shape} shape @returns {[number[], number[]] | null} */
  box(shape) {
    const point = [0, 0, 0];
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (const { end, kind, count } of this.chunks) {
      for (let n = 0; n < count; n += 1) {
        if (kind[n] === KIND.JUMP) continue;
        for (let part = 0; part < shape.points; part += 1) {
          shape.place(point, 0, part, end, n * AXES);
          for (let axis = 0; axis < 3; axis += 1) {
            if (point[axis] < low[axis]) low[axis] = point[axis];
            if (point[axis] > high[axis]) high[axis] = point[axis];
          }
        }
      }
    }
    return low[0] <= high[0] ? [low, high] : null;
  }
}

/** The point before a move. @param {Chunk} chunk @param {number} n @returns {Float32Array} */
export function startOf(chunk, n) {
  return n === 0 ? chunk.start : chunk.end.subarray((n - 1) * AXES, n * AXES);
}

/**
 * Follows the machine through the forecast: the time of a line, searched from where it was found last, because loops
 * execute a line more than once.
 */
export class ForecastClock {
  #at = 0;

  restart() {
    this.#at = 0;
  }

  /**
   * @param {{lines: Uint32Array, times: Float32Array}} forecast @param {number} line
   * @returns {number | undefined} seconds from the start at which this line begins
   */
  timeOf(forecast, line) {
    const { lines, times } = forecast;
    let found = lines.indexOf(line, this.#at);
    if (found < 0) found = lines.indexOf(line);
    if (found < 0) return undefined;
    this.#at = found;
    return found > 0 ? times[found - 1] : 0;
  }
}

/** Number of the forecast's entry that is under way at a time. @param {Float32Array} times ascending @param {number} time */
export function entryAt(times, time) {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

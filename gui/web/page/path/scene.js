/**
 * The tool path in three dimensions: moves in buffer geometry, a piece for each chunk, so that a million of them appear
 * while they still arrive. Draws only when something changed. Coordinates are machine units; Z points up.
 */

import * as THREE from "../vendor/three/three.module.min.js";
import { OrbitControls } from "../vendor/three/OrbitControls.js";
import { KIND } from "./data.js";
import { colourOf } from "./colours.js";

const TRAIL_POINTS = 20_000;
const FRAME_MS = 33; // between two pictures at least
const DRAWING = 2; // times as long as a picture took to draw the page does other things
const PICK_PIXELS = 8;
const GRID_LINES = 2000; // a denser grid would be a plane
const FAR = 1e6;

/** Where the camera stands and what is up, for each view. */
const VIEWS = /** @type {Record<string, [number[], number[]]>} */ ({
  x: [[1, 0, 0], [0, 0, 1]],
  y: [[0, -1, 0], [0, 0, 1]],
  z: [[0, 0, 1], [0, 1, 0]],
  p: [[0.7, -1, 0.75], [0, 0, 1]],
  lathe: [[0, -1, 0], [-1, 0, 0]],
  backlathe: [[0, 1, 0], [1, 0, 0]],
});

/** @typedef {import("./data.js").Chunk} Chunk */
/** @typedef {{lines: THREE.LineSegments, moves: Uint32Array}} Part lines of a chunk, and the move that each belongs to */
/** @typedef {{cut: Part, rapid: Part, chunk: Chunk}} Piece */

export class Scene {
  /** @type {Piece[]} */
  #pieces = [];
  #frame = 0;
  #lastFrame = 0;
  #pause = FRAME_MS;
  #trailCount = 0;
  /** @type {[number[], number[]]} least and greatest corner of what the grid lies under */
  #floor = [[0, 0, 0], [0, 0, 0]];
  gridStep = 0;
  gridAxes = [0, 1];
  visible = true;
  /** Whether the operator turned or moved the picture, so that it is not fitted any more by itself. */
  touched = false;
  /** @type {() => void} called when the picture has another size */
  onresize = () => {};

  /** @param {HTMLElement} place @param {import("./data.js").PathData} data @param {import("./shape.js").Shape} shape */
  constructor(place, data, shape) {
    this.data = data;
    this.shape = shape;
    this.place = place;
    this.colouring = "kind";
    this.showRapids = true;
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, powerPreference: "low-power" });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    place.append(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -FAR, FAR);
    this.controls = this.#makeControls();
    this.lines = new THREE.Group();
    this.marks = new THREE.Group();
    this.scene.add(this.lines, this.marks);
    this.#makeTool();
    this.#makeTrail();
    this.#makeOverlays();
    this.#makeLimits();
    this.setTheme();
    new ResizeObserver(() => {
      this.#resize();
      this.onresize();
    }).observe(place);
    this.#resize();
    this.view("p");
  }

  // ---- things that are always there ----

  /** A cone at the tool; a wire has one at each end. */
  #makeTool() {
    const cone = new THREE.ConeGeometry(0.5, 1.6, 24);
    cone.rotateX(-Math.PI / 2);
    cone.translate(0, 0, 0.8);
    const material = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.85 });
    this.tools = this.#eachPoint(() => new THREE.Mesh(cone, material));
    this.wire = new THREE.Line(new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3()]), new THREE.LineBasicMaterial());
    this.wire.visible = this.tools.length > 1;
    this.wire.frustumCulled = false;
    this.cursor = new THREE.Mesh(new THREE.SphereGeometry(0.35, 16, 12), new THREE.MeshBasicMaterial());
    this.cursor.visible = false;
    this.origin = axesCross();
    this.marks.add(...this.tools, this.wire, this.cursor, this.origin);
  }

  #makeTrail() {
    const material = new THREE.LineBasicMaterial();
    this.trails = this.#eachPoint(() => {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(TRAIL_POINTS * 3), 3));
      geometry.setDrawRange(0, 0);
      const trail = new THREE.Line(geometry, material);
      trail.frustumCulled = false;
      return trail;
    });
    this.marks.add(...this.trails);
  }

  /** One of something for each point that a pose is shown as. @template T @param {() => T} make @returns {T[]} */
  #eachPoint(make) {
    return Array.from({ length: this.shape.points }, make);
  }

  #makeOverlays() {
    const overlay = () => {
      const lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ depthTest: false }));
      lines.renderOrder = 2;
      this.marks.add(lines);
      return lines;
    };
    this.selected = overlay();
    this.outside = overlay();
  }

  #makeLimits() {
    this.limits = new THREE.LineSegments(new THREE.EdgesGeometry(new THREE.BoxGeometry(1, 1, 1)), new THREE.LineBasicMaterial({ transparent: true, opacity: 0.6 }));
    this.limits.visible = false;
    this.grid = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ transparent: true, opacity: 0.7 }));
    this.grid.visible = false;
    this.marks.add(this.limits, this.grid);
  }

  /** Take the colours of the page's theme. */
  setTheme() {
    const style = getComputedStyle(document.documentElement);
    const colour = (/** @type {string} */ name) => new THREE.Color(style.getPropertyValue(name).trim());
    this.dark = document.documentElement.dataset.theme !== "light";
    const paint = (/** @type {any} */ object, /** @type {string} */ name) => object.material.color.copy(colour(name));
    paint(this.tools[0], "--warn");
    paint(this.wire, "--warn");
    paint(this.cursor, "--focus");
    paint(this.trails[0], "--danger");
    paint(this.selected, "--focus");
    paint(this.outside, "--danger");
    paint(this.limits, "--muted");
    paint(this.grid, "--line");
    this.recolour();
  }

  // ---- the path ----

  clear() {
    for (const piece of this.#pieces) {
      for (const { lines } of [piece.cut, piece.rapid]) {
        this.lines.remove(lines);
        lines.geometry.dispose();
      }
    }
    this.#pieces = [];
    this.select(0);
    this.showOutside([]);
    this.cursor.visible = false;
    this.draw();
  }

  /** @param {Chunk} chunk */
  add(chunk) {
    const cuts = [];
    const rapids = [];
    for (let n = 0; n < chunk.count; n += 1) {
      if (chunk.kind[n] === KIND.JUMP) continue;
      (chunk.kind[n] === KIND.RAPID ? rapids : cuts).push(n);
    }
    const piece = { chunk, cut: this.#segments(chunk, cuts, 1), rapid: this.#segments(chunk, rapids, 0.45) };
    piece.rapid.lines.visible = this.showRapids;
    this.#pieces.push(piece);
    this.lines.add(piece.cut.lines, piece.rapid.lines);
    this.#paint(piece);
    this.draw();
  }

  /** @param {Chunk} chunk @param {number[]} numbers of the moves @param {number} opacity @returns {Part} */
  #segments(chunk, numbers, opacity) {
    const counts = numbers.map((n) => this.shape.segments(chunk, n));
    const moves = new Uint32Array(counts.reduce((sum, count) => sum + count, 0));
    const positions = new Float32Array(moves.length * 6);
    let at = 0;
    numbers.forEach((n, k) => {
      this.shape.put(positions, at * 6, chunk, n);
      moves.fill(n, at, at + counts[k]);
      at += counts[k];
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Uint8Array(moves.length * 6), 3, true));
    const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true, transparent: opacity < 1, opacity }));
    return { lines, moves };
  }

  /** @param {Piece} piece */
  #paint(piece) {
    for (const { lines, moves } of [piece.cut, piece.rapid]) {
      const attribute = lines.geometry.getAttribute("color");
      const colours = /** @type {Uint8Array} */ (attribute.array);
      moves.forEach((n, k) => {
        const rgb = colourOf(this.colouring, piece.chunk, n, this.data.feedRange, this.dark);
        for (let at = 0; at < 6; at += 1) colours[k * 6 + at] = rgb[at % 3];
      });
      attribute.needsUpdate = true;
    }
  }

  /** @param {string} [colouring] `kind`, `feed` or `tool` */
  recolour(colouring = this.colouring) {
    this.colouring = colouring;
    for (const piece of this.#pieces) this.#paint(piece);
    this.draw();
  }

  /** @param {boolean} on */
  setRapids(on) {
    this.showRapids = on;
    for (const piece of this.#pieces) piece.rapid.lines.visible = on;
    this.draw();
  }

  /** Highlight the moves of a program line. @param {number} line 0: none */
  select(line) {
    this.#overlay(this.selected, (one) => line > 0 && one === line);
  }

  /** Mark the moves of lines that leave the machine. @param {number[]} lines */
  showOutside(lines) {
    const wanted = new Set(lines);
    this.#overlay(this.outside, (line) => wanted.has(line));
  }

  /** @param {THREE.LineSegments} overlay @param {(line: number) => boolean} wanted */
  #overlay(overlay, wanted) {
    /** @type {number[]} */
    const positions = [];
    this.data.forLines(wanted, (chunk, n) => this.shape.put(positions, positions.length, chunk, n));
    overlay.geometry.dispose();
    overlay.geometry = new THREE.BufferGeometry();
    overlay.geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
    overlay.visible = positions.length > 0;
    this.draw();
  }

  /** Program line of the move under a point of the screen. @param {number} x @param {number} y CSS pixels in the canvas @returns {number} 0: none */
  pick(x, y) {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    const ray = new THREE.Raycaster();
    ray.params.Line.threshold = PICK_PIXELS * this.#unitsPerPixel();
    ray.setFromCamera(new THREE.Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.camera);
    for (const part of /** @type {const} */ (["cut", "rapid"])) {
      const shown = this.#pieces.filter((piece) => piece[part].lines.visible);
      const hits = shown.flatMap((piece) => ray.intersectObject(piece[part].lines).map((hit) => ({ hit, piece })));
      hits.sort((a, b) => a.hit.distance - b.hit.distance);
      if (hits.length) return hits[0].piece.chunk.line[hits[0].piece[part].moves[(hits[0].hit.index ?? 0) >> 1]];
    }
    return 0;
  }

  // ---- the machine ----

  /** @param {ArrayLike<number>} tip nine axes @param {ArrayLike<number>} origin of the work system */
  setTool(tip, origin) {
    const points = this.shape.pointsOf(tip);
    points.forEach((point, k) => this.tools[k].position.set(point[0], point[1], point[2]));
    this.wire.geometry.setFromPoints([this.tools[0].position, this.tools[points.length - 1].position]);
    this.origin.position.set(origin[0], origin[1], origin[2]);
    this.draw();
  }

  /** @param {ArrayLike<number>} tip nine axes */
  addTrail(tip) {
    const full = this.#trailCount === TRAIL_POINTS;
    if (full) this.#trailCount = TRAIL_POINTS / 2;
    const points = this.shape.pointsOf(tip);
    this.trails.forEach((trail, k) => {
      const attribute = trail.geometry.getAttribute("position");
      if (full) attribute.array.copyWithin(0, (TRAIL_POINTS / 2) * 3); // the older half goes
      attribute.setXYZ(this.#trailCount, points[k][0], points[k][1], points[k][2]);
      attribute.needsUpdate = true;
      trail.geometry.setDrawRange(0, this.#trailCount + 1);
    });
    this.#trailCount += 1;
    this.draw();
  }

  clearTrail() {
    this.#trailCount = 0;
    for (const trail of this.trails) trail.geometry.setDrawRange(0, 0);
    this.draw();
  }

  /** Mark a point of the forecast. @param {ArrayLike<number> | null} pose nine axes */
  setCursor(pose) {
    this.cursor.visible = pose !== null;
    if (pose) {
      const [x, y, z] = this.shape.pointsOf(pose)[0];
      this.cursor.position.set(x, y, z);
    }
    this.draw();
  }

  /** Lines of a grid on the floor of the limits, of a lathe on its plane. @param {number} step between two of them, machine units; 0: none */
  setGrid(step) {
    this.grid.geometry.dispose();
    this.grid.geometry = new THREE.BufferGeometry();
    this.grid.geometry.setAttribute("position", new THREE.Float32BufferAttribute(gridLines(this.#floor, this.gridAxes, step), 3));
    this.grid.visible = step > 0;
    this.gridStep = step;
    this.draw();
  }

  /** @param {number[]} low @param {number[]} high */
  setLimits(low, high) {
    this.limits.visible = [...low, ...high].every((value) => Number.isFinite(value) && Math.abs(value) < FAR);
    this.limits.scale.set(...size(low, high));
    this.limits.position.set(...middle(low, high));
    const floor = this.limits.visible ? [low, high] : (this.data.box(this.shape) ?? this.#floor);
    if (floor.flat().join() !== this.#floor.flat().join()) {
      this.#floor = floor;
      this.setGrid(this.gridStep);
    }
    this.draw();
  }

  // ---- the camera ----

  /** @param {string} name of VIEWS */
  view(name) {
    const [from, up] = VIEWS[name];
    const target = this.controls.target;
    this.camera.up.set(up[0], up[1], up[2]);
    this.camera.position.set(target.x + from[0] * 1000, target.y + from[1] * 1000, target.z + from[2] * 1000);
    this.controls.dispose(); // it keeps the up vector that it was made with
    this.controls = this.#makeControls();
    this.controls.target.copy(target);
    this.controls.update();
    this.draw();
  }

  #makeControls() {
    const controls = new OrbitControls(this.camera, this.renderer.domElement);
    controls.enableDamping = false;
    controls.addEventListener("change", () => this.draw());
    controls.addEventListener("start", () => (this.touched = true));
    return controls;
  }

  /** Show a box in full. @param {number[]} low @param {number[]} high */
  fit(low, high) {
    this.touched = false;
    const centre = middle(low, high);
    const offset = this.camera.position.clone().sub(this.controls.target);
    this.controls.target.set(...centre);
    this.camera.position.copy(this.controls.target).add(offset);
    this.camera.updateMatrixWorld();
    const inverse = this.camera.matrixWorld.clone().invert();
    let [width, height] = [0, 0];
    for (let corner = 0; corner < 8; corner += 1) {
      const point = new THREE.Vector3(...[0, 1, 2].map((axis) => ((corner >> axis) & 1 ? high[axis] : low[axis])));
      point.applyMatrix4(inverse);
      width = Math.max(width, Math.abs(point.x));
      height = Math.max(height, Math.abs(point.y));
    }
    const { clientWidth, clientHeight } = this.place;
    const half = 1.12 * Math.max(height, (width * clientHeight) / Math.max(clientWidth, 1), 1e-3);
    this.camera.zoom = 1;
    this.camera.top = half;
    this.#resize();
    this.controls.update();
  }

  #unitsPerPixel() {
    return (this.camera.top - this.camera.bottom) / this.camera.zoom / Math.max(this.place.clientHeight, 1);
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (!width || !height) return;
    this.renderer.setSize(width, height);
    const half = this.camera.top;
    Object.assign(this.camera, { bottom: -half, left: (-half * width) / height, right: (half * width) / height });
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Ask for a picture; several requests make one. */
  draw() {
    if (this.#frame || !this.visible) return;
    const wait = Math.max(0, this.#pause - (performance.now() - this.#lastFrame));
    this.#frame = window.setTimeout(() => requestAnimationFrame(() => this.#render()), wait);
  }

  #render() {
    this.#frame = 0;
    const began = performance.now();
    const mark = this.#unitsPerPixel() * 16; // marks keep their size on the screen
    for (const object of [...this.tools, this.cursor]) object.scale.setScalar(mark);
    this.origin.scale.setScalar(mark * 2.5);
    this.renderer.render(this.scene, this.camera);
    this.#lastFrame = performance.now();
    this.#pause = Math.max(FRAME_MS, DRAWING * (this.#lastFrame - began));
  }
}

/**
 * Ends of lines along two axes at multiples of a step; where the third is least.
 * @param {[number[], number[]]} floor @param {number[]} axes @param {number} step
 */
function gridLines([low, high], axes, step) {
  /** @type {number[]} */
  const ends = [];
  if (!(step > 0)) return ends;
  for (const [along, across] of [axes, [...axes].reverse()]) {
    if ((high[across] - low[across]) / step > GRID_LINES) return [];
    for (let at = Math.ceil(low[across] / step) * step; at <= high[across]; at += step) {
      for (const side of [low, high]) {
        const end = [...low];
        end[along] = side[along];
        end[across] = at;
        ends.push(...end);
      }
    }
  }
  return ends;
}

/** @param {number[]} low @param {number[]} high @returns {[number, number, number]} */
const middle = (low, high) => [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2];
/** @param {number[]} low @param {number[]} high @returns {[number, number, number]} */
const size = (low, high) => [high[0] - low[0], high[1] - low[1], high[2] - low[2]];

/** X red, Y green, Z blue. */
function axesCross() {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute([0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1], 3));
  const colours = ["#f0506e", "#3ec46d", "#4b8df8"].flatMap((text) => [...new THREE.Color(text).toArray(), ...new THREE.Color(text).toArray()]);
  geometry.setAttribute("color", new THREE.Float32BufferAttribute(colours, 3));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true }));
}

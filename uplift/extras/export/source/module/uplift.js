// Spectral uplifting cubes in JavaScript: linear RGB in, reflectances out, in single precision. For browsers and node.
//
//   import { open } from "./uplift.js";
//   const cube = await open("paints.uplift");
//   const reflectances = cube.reflectances([0.8, 0.2, 0.1], [450, 500, 550, 600]);
//
// It contains uplift.h, compiled to WebAssembly, and reads cube files (.uplift) of the formats 3 and ${format}: of every
// space, model and atlas, and those that were built for a scene. Written by `uplift export --runtime`.
//
// Copyright (c) 2026, the uplift developers. BSD 3-Clause License; its text is in uplift.h and in uplift.

const CODE = "${code}";
const BLOCK = 1 << 16; // numbers in and out of a block of colours
const NO_FILE = 1; // results of uplift.h
const NO_MEMORY = 2;
const SLACK = 1e-6; // distance from [0, 1] that is rounding
const RANGE = [100, 5000]; // wavelengths in nm
const FILES = "node:fs/promises";
let compiled;

/** A cube that cannot be opened, or a colour that it has no answer for. `result` is the number of the reason in uplift.h. */
export class CubeError extends Error {
  constructor(message, result) {
    super(message);
    this.name = "CubeError";
    this.result = result;
  }
}

/**
 * Open a cube.
 * @param {ArrayBuffer|ArrayBufferView|Blob|Response|Request|string|URL} source the bytes of a cube file, a Blob or Response that has
 * them, or an address to fetch them from; in node also the path or `file:` URL of a file
 * @returns {Promise<Cube>}
 * @throws {CubeError} if they cannot be read, or are no cube, damaged or of a later format
 */
export async function open(source) {
  const bytes = await read(await source);
  compiled ??= compile();
  const { exports } = await WebAssembly.instantiate(await compiled, { env: Math });
  return new Cube(exports, bytes);
}

async function read(source) {
  if (source instanceof ArrayBuffer) return new Uint8Array(source);
  if (ArrayBuffer.isView(source)) return new Uint8Array(source.buffer, source.byteOffset, source.byteLength);
  const isAddress = typeof source === "string" || source instanceof URL || source instanceof Request;
  if (!isAddress && typeof source?.arrayBuffer !== "function")
    throw new TypeError(`open takes bytes, a Blob, a Response or an address, got ${source}`);
  const name = source.url || String(source);
  try {
    if (isAddress && isFile(name)) return await readFile(name);
    const body = isAddress ? await fetch(source) : source;
    if (body.ok === false) throw new Error(body.status);
    return new Uint8Array(await body.arrayBuffer());
  } catch (error) {
    throw new CubeError(`${name} cannot be read: ${error.cause?.message ?? error.message}`, NO_FILE);
  }
}

// Only node reads files; a page fetches what stands next to it. One letter and a colon are a drive.
function isFile(address) {
  return Boolean(globalThis.process?.versions?.node) && /^file:|^(?![a-z][a-z\d+.-]+:)/i.test(address);
}

async function readFile(address) {
  const files = await import(/* webpackIgnore: true */ FILES);
  return files.readFile(/^file:/i.test(address) ? new URL(address) : address);
}

async function compile() {
  const bytes = Uint8Array.from(atob(CODE), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}

function expectNumbers(name, values, group) {
  if (values?.length % group === 0) return;
  throw new RangeError(`${name} must be an array whose length is a multiple of ${group}, got ${values?.length ?? values}`);
}

function expectInside(name, values, low, high, slack, hint) {
  for (const value of values)
    if (!(Number.isFinite(value) && value >= low - slack && value <= high + slack))
      throw new RangeError(`${name} must be in [${low}, ${high}], got ${typeof value === "number" ? value : typeof value}: ${hint}`);
}

/** A cube, in a memory of its own. Methods take linear RGB of n colours, three numbers in [0, 1] each; answers have the same order. */
class Cube {
  #exports;
  #pointer;

  constructor(exports, bytes) {
    this.#exports = exports;
    const file = this.#allocate(exports.malloc, bytes.length);
    const error = this.#allocate(exports.malloc, 4);
    new Uint8Array(exports.memory.buffer).set(bytes, file);
    this.#pointer = exports.uplift_open_memory(file, bytes.length, error);
    this.#check(new DataView(exports.memory.buffer).getInt32(error, true));
  }

  /** Numbers of the spectrum of a colour, for `coefficients`. */
  get coefficientCount() {
    return this.#exports.uplift_coefficient_count(this.#pointer);
  }

  /**
   * Reflectances at N wavelengths in nm; their colours are exactly these RGB.
   * @returns {Float32Array} n rows of N
   * @throws {CubeError} for a colour that is not in the scene of the cube
   */
  reflectances(rgb, wavelengths) {
    expectNumbers("wavelengths", wavelengths, 1);
    expectInside("wavelengths", wavelengths, ...RANGE, 0, "give nm");
    const evaluate = this.#exports.uplift_reflectances_n;
    const size = wavelengths.length;
    return this.#answer(rgb, size, wavelengths, (colours, count, at, answers) =>
      evaluate(this.#pointer, colours, count, at, size, answers));
  }

  /**
   * Coefficients, which are linear in the spectrum and can be filtered.
   * @returns {Float32Array} n rows of `coefficientCount`
   * @throws {CubeError} next to nodes without their own colours
   */
  coefficients(rgb) {
    return this.#answerEach(rgb, this.coefficientCount, this.#exports.uplift_coefficients);
  }

  /** CIEDE2000 that 68 % of measurements of a colour stay within, under the illuminant `reference` of the cube. */
  standardError(rgb) {
    return this.#answerEach(rgb, 1, this.#exports.uplift_standard_error);
  }

  /** The same for 95 %. */
  errorBound(rgb) {
    return this.#answerEach(rgb, 1, this.#exports.uplift_error_bound);
  }

  #answerEach(rgb, width, evaluate) {
    return this.#answer(rgb, width, [], (colours, count, at, answers) => {
      let result = 0;
      for (let k = 0; k < count && !result; ++k)
        result = evaluate(this.#pointer, colours + 12 * k, answers + 4 * width * k);
      return result;
    });
  }

  // `width` numbers for each colour, block by block, by a function of pointers that returns a result.
  #answer(rgb, width, at, evaluate) {
    expectNumbers("rgb", rgb, 3);
    if (rgb instanceof Uint8Array || rgb instanceof Uint8ClampedArray)
      throw new RangeError("linear RGB must be floats, got an array of 8-bit codes: decode them before");
    expectInside("linear RGB", rgb, 0, 1, SLACK, "decode 8-bit codes, and map colours into the gamut, before");
    const total = rgb.length / 3;
    const found = new Float32Array(total * width);
    const most = Math.min(total, Math.ceil(BLOCK / (3 + width)));
    const place = this.#allocate(this.#exports.uplift_scratch, 4 * (at.length + most * (3 + width)));
    const memory = new Float32Array(this.#exports.memory.buffer, place);
    memory.set(at);
    for (let first = 0; first < total; first += most) {
      const count = Math.min(most, total - first);
      const colours = at.length;
      const answers = colours + 3 * count;
      for (let k = 0; k < 3 * count; ++k) memory[colours + k] = rgb[3 * first + k];
      this.#check(evaluate(place + 4 * colours, count, place, place + 4 * answers));
      found.set(memory.subarray(answers, answers + count * width), first * width);
    }
    return found;
  }

  #allocate(give, size) {
    const place = give(size) >>> 0;
    if (!place) this.#check(NO_MEMORY);
    return place;
  }

  #check(result) {
    if (!result) return;
    const text = new Uint8Array(this.#exports.memory.buffer, this.#exports.uplift_message(result));
    throw new CubeError(new TextDecoder().decode(text.subarray(0, text.indexOf(0))), result);
  }
}

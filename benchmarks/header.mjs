/* Rates of uplift.js: header.mjs CUBE COLOURS WAVELENGTHS RUNS REFLECTANCES, as header.c. */
import { readFileSync, writeFileSync } from "node:fs";
import { open } from "./uplift.mjs";

const numbers = path => new Float32Array(Uint8Array.from(readFileSync(path)).buffer);
const [cubePath, colours, wavelengths, runs, reflectances] = process.argv.slice(2);
const cube = await open(readFileSync(cubePath));
const rgb = numbers(colours);
const at = numbers(wavelengths);
let best = Infinity;
let found;
for (let run = 0; run < runs; ++run) {
  const begin = process.cpuUsage();
  found = cube.reflectances(rgb, at);
  const { user, system } = process.cpuUsage(begin);
  best = Math.min(best, (user + system) / 1e6);
}
writeFileSync(reflectances, found);
console.log(best);

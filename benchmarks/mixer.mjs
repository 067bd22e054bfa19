/* Rate of an exported mixer: mixer.mjs COLOURS RUNS, in the folder of paint.mjs; COLOURS are those of mixer.c.

   Prints the fewest seconds of the runs for a pair. */
import { readFileSync } from "node:fs";
import { mix } from "./paint.mjs";

const [colours, runs] = process.argv.slice(2);
const numbers = new Float32Array(new Uint8Array(readFileSync(colours)).buffer);
const pairs = Array.from({ length: numbers.length / 6 }, (_, i) => [
  Array.from(numbers.subarray(6 * i, 6 * i + 3)),
  Array.from(numbers.subarray(6 * i + 3, 6 * i + 6)),
  (i % 100) / 99,
]);
let best = Infinity;
let sum = 0;
for (let run = 0; run < Number(runs); ++run) {
  const begin = performance.now(); // CPU times count the compiler's threads
  for (const pair of pairs) sum += mix(pair[0], pair[1], pair[2])[0];
  best = Math.min(best, performance.now() - begin);
}
console.log(sum > 0 ? (best * 1e-3) / pairs.length : NaN);

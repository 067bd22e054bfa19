// Spectra 1 / (1 + exp(−x − B q)), where x is that of the cube's answer. The solver moves q, in the metric of least
// change, to goals for a* and b* under some lights, and keeps the RGB.
const RGB_WEIGHT = 300; // a residual of linear RGB counts as much as this one of a* or b*
const TOLERANCE = 1e-3; // of weighted residuals
const MAX_STEPS = 60;
const MAX_CHANGE = 4; // of x + B q in one step
const FIRST_DAMPING = 1e-6;
const MAX_RGB_ERROR = 1e-5;
const STAGES = 6; // between the answer and goals that are not reached at once

const logistic = x => 1 / (1 + Math.exp(-x));
const argumentsOf = (model, q) => model.start.map((x, i) => x + dot(model.basis[i], q));
const reflectanceOf = (model, q) => argumentsOf(model, q).map(logistic);

// Weighted residuals, and rows of weights over the wavelengths whose products with the slopes are their derivatives.
function equations(model, goals, reflectance) {
  const rgb = multiply(model.sensor, reflectance);
  const off = model.target.map((value, k) => RGB_WEIGHT * (value - rgb[k]));
  const rows = model.sensor.map(row => row.map(value => RGB_WEIGHT * value));
  for (const { light, goal } of goals) {
    const xyz = multiply(light.xyz, reflectance);
    const [, a, b] = xyzToLab(xyz, light.white);
    off.push(goal[0] - a, goal[1] - b);
    for (const slopes of slopesOfAb(xyz, light.white))
      rows.push(light.xyz[0].map((_, i) => slopes[0] * light.xyz[0][i] + slopes[1] * light.xyz[1][i] + slopes[2] * light.xyz[2][i]));
  }
  return { off, rows };
}

function jacobian(model, rows, reflectance, count) {
  const slope = reflectance.map(value => value * (1 - value));
  return rows.map(row => {
    const found = new Array(count).fill(0);
    row.forEach((weight, i) => {
      const factor = weight * slope[i];
      model.basis[i].forEach((value, c) => (found[c] += factor * value));
    });
    return found;
  });
}

// Solve (A + shift I) y = b for symmetric positive A by L D Lᵀ. Pivots are kept positive: a step may be long, never NaN.
function solve(matrix, shift, right) {
  const n = right.length;
  const floor = 1e-22 * matrix.reduce((sum, row, i) => sum + row[i], 0) + 1e-300;
  const lower = matrix.map(row => row.slice());
  const pivots = new Array(n);
  for (let j = 0; j < n; j++) {
    let pivot = matrix[j][j] + shift;
    for (let k = 0; k < j; k++) pivot -= lower[j][k] ** 2 * pivots[k];
    pivots[j] = Math.max(pivot, floor);
    for (let i = j + 1; i < n; i++) {
      let value = matrix[i][j];
      for (let k = 0; k < j; k++) value -= lower[i][k] * lower[j][k] * pivots[k];
      lower[i][j] = value / pivots[j];
    }
  }
  const y = right.slice();
  for (let i = 0; i < n; i++) for (let k = 0; k < i; k++) y[i] -= lower[i][k] * y[k];
  for (let i = 0; i < n; i++) y[i] /= pivots[i];
  for (let i = n - 1; i >= 0; i--) for (let k = i + 1; k < n; k++) y[i] -= lower[k][i] * y[k];
  return y;
}

// Of all changes that cancel the residuals to first order, the smallest. Rows are scaled to length 1 for the damping.
function leastChange(rows, off, damping) {
  const scales = rows.map(row => 1 / Math.sqrt(dot(row, row) + 1e-30));
  const scaled = rows.map((row, i) => row.map(value => value * scales[i]));
  const gram = scaled.map(first => scaled.map(second => dot(first, second)));
  const y = solve(gram, damping, off.map((value, i) => value * scales[i]));
  return rows[0].map((_, c) => scaled.reduce((sum, row, i) => sum + row[c] * y[i], 0));
}

// Steps from q until the residuals are small. A step is taken if it reduces them.
function descend(model, goals, start, tolerance = TOLERANCE) {
  let q = start;
  let reflectance = reflectanceOf(model, q);
  let { off, rows } = equations(model, goals, reflectance);
  let damping = FIRST_DAMPING;
  for (let step = 0; step < MAX_STEPS && Math.max(...off.map(Math.abs)) > tolerance; step++) {
    const change = leastChange(jacobian(model, rows, reflectance, q.length), off, damping);
    const largest = Math.max(...model.basis.map(row => Math.abs(dot(row, change))));
    const trial = q.map((value, c) => value + change[c] * Math.min(1, MAX_CHANGE / largest));
    const trialReflectance = reflectanceOf(model, trial);
    const next = equations(model, goals, trialReflectance);
    if (dot(next.off, next.off) < dot(off, off)) {
      q = trial;
      reflectance = trialReflectance;
      ({ off, rows } = next);
      damping = Math.max(damping / 4, 1e-12);
    } else damping *= 4;
  }
  return { q, size: Math.sqrt(dot(off, off)) };
}

const rgbError = (model, q) => {
  const rgb = multiply(model.sensor, reflectanceOf(model, q));
  return Math.max(...rgb.map((value, k) => Math.abs(value - model.target[k])));
};

// q for the goals, in one go from the answer or, if they are not reached, in stages. It depends on nothing but the goals.
// The RGB has priority: without it, the answer stays.
function solveGoals(model, goals) {
  const zero = model.basis[0].map(() => 0);
  let best = descend(model, goals, zero);
  if (best.size > 0.1) {
    const answer = reflectanceOf(model, zero);
    const from = goals.map(({ light }) => labOf(light, answer).slice(1));
    let q = zero;
    for (let stage = 1; stage <= STAGES; stage++) {
      const between = goals.map(({ light, goal }, k) => ({ light, goal: goal.map((value, axis) => from[k][axis] + (stage / STAGES) * (value - from[k][axis])) }));
      const found = descend(model, between, q);
      q = found.q;
      if (stage === STAGES && found.size < best.size) best = found;
    }
  }
  const { q } = descend(model, [], best.q, 1e-6);
  return rgbError(model, q) <= MAX_RGB_ERROR ? q : zero;
}

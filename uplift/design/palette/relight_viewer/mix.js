// Weights of the lights. Positions are on a disc of radius 1 with y pointing down.
const dot = (a, b) => a.reduce((total, value, k) => total + value * b[k], 0);
const multiply = (matrix, vector) => matrix.map(row => dot(row, vector));
const weightedSum = (weights, rows) => rows[0].map((_, k) => dot(weights, rows.map(row => row[k])));

// Positions of the lights on the rim, the first at the top.
function rimPositions(count) {
  const angle = j => (2 * Math.PI * j) / count - Math.PI / 2;
  return Array.from({ length: count }, (_, j) => [Math.cos(angle(j)), Math.sin(angle(j))]);
}

// Shares of the lights at a position by the inverse square of their distance; 1 for a light at the position itself.
function shares([x, y], lights) {
  const squares = lights.map(([u, v]) => (x - u) ** 2 + (y - v) ** 2);
  const here = squares.findIndex(square => square < 1e-12);
  if (here >= 0) return squares.map((_, j) => Number(j === here));
  const total = squares.reduce((inverse, square) => inverse + 1 / square, 0);
  return squares.map(square => 1 / square / total);
}

function clampToDisc([x, y]) {
  const radius = Math.max(1, Math.hypot(x, y));
  return [x / radius, y / radius];
}

// What the hands have set, and what follows from it. Positions are on a disc of radius 1; y points down, as on screens.
const dot = (these, those) => these.reduce((total, value, k) => total + value * those[k], 0);
const times = (matrix, vector) => matrix.map(row => dot(row, vector));
const sum = (weights, rows) => rows[0].map((_, k) => dot(weights, rows.map(row => row[k])));

// Lights stand on the rim, the first at the top.
function places(count) {
  const turn = j => (2 * Math.PI * j) / count - Math.PI / 2;
  return Array.from({ length: count }, (_, j) => [Math.cos(turn(j)), Math.sin(turn(j))]);
}

// Shares of the lights at a position: by the inverse square of their distance, all of one where it stands.
function shares([x, y], lights) {
  const squares = lights.map(([u, v]) => (x - u) ** 2 + (y - v) ** 2);
  const here = squares.findIndex(square => square < 1e-12);
  if (here >= 0) return squares.map((_, j) => Number(j === here));
  const total = squares.reduce((inverse, square) => inverse + 1 / square, 0);
  return squares.map(square => 1 / square / total);
}

function onDisc([x, y]) {
  const radius = Math.max(1, Math.hypot(x, y));
  return [x / radius, y / radius];
}

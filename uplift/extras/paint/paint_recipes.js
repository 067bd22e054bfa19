// The recipes of a colour: the best of a grid of ratios for each set of paints, followed by a pattern search.
const LEVELS = [-5, -3.5, -2, -1, 0, 1, 2, 3.5, 5];
const FOLLOWED = 24;
const SHOWN = 5;
const MOST_PARTS = 40;

function* setsOf(count, first = 0) {
  if (!count) yield [];
  else for (let paint = first; paint < names.length; ++paint)
    for (const others of setsOf(count - 1, paint + 1)) yield [paint, ...others];
}

const partsOf = ratios => [1, ...ratios.map(Math.exp)];
const errorOf = (members, ratios, goal) => deltaE(labOf(opaque(members, partsOf(ratios))), goal);

// The best of a grid of logarithms of ratios to the first paint.
function start(members, goal) {
  let best = { error: Infinity };
  const grid = members.slice(1).reduce((rows, _) => rows.flatMap(row => LEVELS.map(level => [...row, level])), [[]]);
  for (const ratios of grid) {
    const error = errorOf(members, ratios, goal);
    if (error < best.error) best = { members, ratios, error };
  }
  return best;
}

// Pattern search: the step halves where no neighbour is better.
function follow({ members, ratios, error }, goal) {
  for (let step = 0.8; step > 0.004;) {
    let isBetter = false;
    for (let i = 0; i < ratios.length; ++i) for (const sign of [-1, 1]) {
      const trial = ratios.with(i, ratios[i] + sign * step);
      const changed = errorOf(members, trial, goal);
      if (changed < error) [ratios, error, isBetter] = [trial, changed, true];
    }
    if (!isBetter) step /= 2;
  }
  return { members, ratios, error };
}

// The fewest whole parts that are nearly as good as any.
function whole({ members, ratios }, goal) {
  const shares = partsOf(ratios);
  const sum = shares.reduce((total, share) => total + share);
  let best = { error: Infinity };
  for (let total = 1; total <= MOST_PARTS; ++total) {
    const parts = shares.map(share => Math.round(total * share / sum));
    const kept = members.filter((_, i) => parts[i]);
    const counts = parts.filter(Boolean);
    if (!kept.length) continue;
    const error = deltaE(labOf(opaque(kept, counts)), goal);
    if (error < best.error - 0.1) best = { members: kept, parts: counts, error };
  }
  return best;
}

// The nearest recipes of up to `count` paints for a colour in L*a*b*, each of another set.
function recipesFor(goal, count) {
  const sizes = Array.from({ length: count }, (_, i) => i + 1);
  const starts = sizes.flatMap(size => [...setsOf(size)]).map(members => start(members, goal));
  const nearest = starts.sort((a, b) => a.error - b.error).slice(0, FOLLOWED);
  const found = nearest.map(recipe => whole(follow(recipe, goal), goal)).sort((a, b) => a.error - b.error);
  const keys = found.map(recipe => recipe.members.join());
  return found.filter((_, i) => keys.indexOf(keys[i]) === i).slice(0, SHOWN);
}

// Numbers and sentences.

const number = (value) => Math.round(value).toLocaleString("en-US");
const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
const share = (part, whole) => `${((100 * part) / whole).toFixed(part < whole / 50 && part > 0 ? 1 : 0)}%`;
const counted = (count, noun) => `${number(count)} ${noun}${Math.round(count) === 1 ? "" : "s"}`;
const oneDigit = (value) => (value >= 100 || Number.isInteger(value) ? number(value) : value.toFixed(1));
const coordinate = (value) => Number(value.toPrecision(5)).toString();

/** Returns how beams share the work of the rays that they contain; null without beams. */
function beamSharing(structure, work) {
  if (!structure.beams) return null;
  const { paths, beams } = structure;
  let background = 0;
  let together = 0;
  for (let ray = 0; ray < work.passed.length; ++ray) {
    together += work.passed[ray];
    const last = paths.first_beam[ray + 1] - 1;
    if (last >= paths.first_beam[ray] && beams.kinds[paths.beam[last]] === BEAM.leaves) ++background;
  }
  const exits = beams.kinds.filter((kind) => kind === BEAM.leaves).length;
  return { background, together, exits, beams: beams.kinds.length };
}

function sentenceOf(structure, work) {
  const rays = work.steps.length;
  const sharing = beamSharing(structure, work);
  if (sharing && sharing.together > 0) {
    const saved = sharing.together / Math.max(sharing.beams, 1);
    const background = sharing.background > 0
      ? `${counted(sharing.exits, "exit beam")}, which left the scene through empty leaves, decided ` +
        `${share(sharing.background, rays)} of the pixels at once: they are background, and none of their rays was ` +
        "traced or tested."
      : "No beam leaves the scene here: each pixel becomes a ray where its beam meets an occupied leaf.";
    return `${structure.label} traces beams, bundles of the rays of neighboring pixels, through an octree, and divides ` +
      `them by its leaves. The beams entered ${number(sharing.beams)} leaves; one by one, the ${number(rays)} rays ` +
      `would enter ${number(sharing.together)}, ${oneDigit(saved)}x as many (work is counted here, not timed). ${background}`;
  }
  if (structure.tiles) {
    const ways = structure.tiles.ways;
    const alone = ways.filter((way) => way === 0).length;
    const empty = ways.filter((way) => way === 1).length;
    return `${structure.label} traces the image in tiles of pixels: ${share(empty, rays)} of the pixels are ` +
      `background, for which no ray is traced, and ${share(alone, rays)} are traced alone. As a single ray, a pixel takes ` +
      `${oneDigit(mean(work.steps))} steps and ${oneDigit(mean(work.tests))} ray-primitive tests.`;
  }
  if (work.steps.every((steps) => steps === 0)) {
    return `${structure.label} does not record the steps of its rays.`;
  }
  return `With ${structure.label}, a ray takes ${oneDigit(mean(work.steps))} steps and ` +
    `${oneDigit(mean(work.tests))} ray-primitive tests on average, at most ` +
    `${number(Math.max(...work.steps))} and ${number(Math.max(...work.tests))}.`;
}

/** Returns the sentence at the top of the page: what one structure does, or which of two does less work. */
function comparison(structures, works) {
  if (structures.length === 1) return sentenceOf(structures[0], works[0]);
  const cost = works.map((work) => mean(work.tests));
  const steps = works.map((work) => mean(work.steps) + mean(work.passed));
  const [less, more] = cost[0] <= cost[1] ? [0, 1] : [1, 0];
  const factor = cost[less] > 0 ? cost[more] / cost[less] : Infinity;
  const than = factor > 1.05 && Number.isFinite(factor) ? `, ${factor.toFixed(1)}x fewer than the` : ", compared with";
  return `A ray makes ${oneDigit(cost[less])} ray-primitive tests with ${structures[less].label}${than} ` +
    `${oneDigit(cost[more])} with ${structures[more].label}; it passes ${oneDigit(steps[less])} and ` +
    `${oneDigit(steps[more])} places. Work is counted here, not timed.`;
}

function notesOf(data) {
  const { scene, image } = data;
  const notes = [
    `${scene.name}: ${counted(scene.primitives, "primitive")}; the primary rays of ` +
      `${image.width}x${image.height} pixels, camera "${image.camera}".`,
  ];
  const shown = scene.mesh.triangles.length / 3;
  if (shown < scene.mesh.of) {
    notes.push(`Decimated for display: ${number(shown)} of ${number(scene.mesh.of)} triangles are shown; ` +
      "the structures were built over all.");
  }
  for (const { label, cells } of data.structures) {
    const boxes = cells.levels.length;
    if (boxes < cells.of) notes.push(`${label}: ${number(boxes)} of ${number(cells.of)} ${cells.kind} are shown.`);
  }
  return notes.join(" ");
}

function factsOf(structure) {
  const { statistics } = structure;
  const facts = [];
  if (statistics.nodes > 0) facts.push(`${number(statistics.nodes)} nodes`);
  if (statistics.leaves > 0) facts.push(`${number(statistics.leaves)} leaves (${number(statistics.empty_leaves)} empty)`);
  if (statistics.depth > 1) facts.push(`depth ${statistics.depth}`);
  return facts.join(", ");
}

/** Returns the area of a polygon in pixels, at least 1. */
function areaOf(corners) {
  let twice = 0;
  for (let i = 0; i < corners.length; i += 2) {
    const next = (i + 2) % corners.length;
    twice += corners[i] * corners[next + 1] - corners[next] * corners[i + 1];
  }
  return Math.max(1, Math.abs(twice) / 2);
}

/** Returns the lines about one step: [text, class]. */
function linesOf(step) {
  const lines = [];
  const place = `${step.word} ${number(step.index)}${step.level > 0 ? `, level ${step.level}` : ""}`;
  if (step.beam) {
    const what = ["An empty leaf: the beam continues", "An occupied leaf: the beam's pixels become rays",
      "The end of the scene: the beam's pixels are background, and no rays are traced"][step.beam.kind];
    lines.push([`${place}. ${what}.`], [`The beam has ${step.beam.corners.length / 2} edges and covers ${counted(areaOf(step.beam.corners), "pixel")}.`]);
    return lines;
  }
  const end = step.exit < 1e30 ? ` to ${coordinate(step.exit)}` : " on";
  lines.push([`${place}, from t = ${coordinate(step.enter)}${end}.`]);
  const missed = step.tests.filter((test) => !test.isHit).length + step.omitted;
  const tests = step.tests.length + step.omitted;
  if (tests === 0) lines.push([step.word === "node" || step.word === "volume" ? "Its children come next." : "Nothing to test."]);
  else lines.push([`${counted(tests, "ray-primitive test")}, ${number(missed)} missed.`]);
  for (const test of step.tests.filter((each) => each.isHit).slice(-4)) {
    const best = step.best && test.primitive === step.best.primitive;
    lines.push([`Primitive ${number(test.primitive)} is met at t = ${coordinate(test.t)}${best ? "" : ", beyond the best"}.`, best ? "hit" : ""]);
  }
  if (step.best && !step.tests.includes(step.best)) lines.push([`Best so far: primitive ${number(step.best.primitive)} at t = ${coordinate(step.best.t)}.`]);
  return lines;
}

// Reads the page's data: JSON, in which arrays are places in one compressed block of bytes.

async function readData() {
  const data = JSON.parse(document.getElementById("data").textContent);
  const packed = Uint8Array.from(atob(data.arrays), (digit) => digit.charCodeAt(0));
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = await new Response(unpacked).arrayBuffer();
  const kinds = { Float32: Float32Array, Uint32: Uint32Array, Uint16: Uint16Array, Uint8: Uint8Array };
  const withArrays = (value) => {
    if (value === null || typeof value !== "object") return value;
    if (value.type in kinds) return new kinds[value.type](bytes, value.at, value.count);
    for (const key in value) value[key] = withArrays(value[key]);
    return value;
  };
  delete data.arrays;
  return withArrays(data);
}

const NO_PRIMITIVE = 0xffffffff;
const BEAM = { goesOn: 0, occupied: 1, leaves: 2 };

/** Returns each ray's numbers of steps, ray-primitive tests, and leaves passed in beams. */
function countWork(structure) {
  const { first_step: firstStep, first_test: firstTest, first_beam: firstBeam, omitted } = structure.paths;
  const rays = firstStep.length - 1;
  const work = { steps: new Float32Array(rays), tests: new Float32Array(rays), passed: new Float32Array(rays) };
  for (let ray = 0; ray < rays; ++ray) {
    work.steps[ray] = firstStep[ray + 1] - firstStep[ray];
    work.tests[ray] = firstTest[firstStep[ray + 1]] - firstTest[firstStep[ray]];
    for (let step = firstStep[ray]; step < firstStep[ray + 1]; ++step) work.tests[ray] += omitted[step];
    work.passed[ray] = firstBeam[ray + 1] - firstBeam[ray];
  }
  return work;
}

/** Returns the steps of one ray: the beams that contain it, then the places that it enters itself. */
function stepsOf(structure, ray) {
  const { paths } = structure;
  const placeOf = (number) => {
    const [word, index, level, hasBox] = paths.places[number];
    return { word, index, level, box: hasBox ? paths.boxes.subarray(6 * number, 6 * number + 6) : null };
  };
  const steps = [];
  for (let i = paths.first_beam[ray]; i < paths.first_beam[ray + 1]; ++i) {
    const { kinds, first, corners } = structure.beams;
    const beam = paths.beam[i];
    const outline = [...corners.subarray(2 * first[beam], 2 * first[beam + 1])];
    steps.push({ beam: { number: beam, kind: kinds[beam], corners: outline }, ...placeOf(paths.beam_place[i]), tests: [], omitted: 0 });
  }
  let best = null;
  for (let i = paths.first_step[ray]; i < paths.first_step[ray + 1]; ++i) {
    const tests = [];
    for (let j = paths.first_test[i]; j < paths.first_test[i + 1]; ++j) {
      const t = paths.t[j];
      const test = { primitive: paths.primitive[j], t, isHit: t === t };
      if (test.isHit && (!best || t < best.t)) best = test;
      tests.push(test);
    }
    steps.push({
      ...placeOf(paths.place[i]), enter: paths.enter[i], exit: paths.exit[i],
      tests, omitted: paths.omitted[i], best,
    });
  }
  return steps;
}

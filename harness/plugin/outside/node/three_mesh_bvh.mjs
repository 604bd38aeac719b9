// three-mesh-bvh: its hierarchy over a BufferGeometry, vertices in float, tests in double.
import fs from "node:fs";
import readline from "node:readline";
import * as THREE from "three";
import { MeshBVH } from "three-mesh-bvh";

const packages = JSON.parse(fs.readFileSync(new URL("./package.json", import.meta.url)));
const description = {
  name: "three-mesh-bvh",
  description: "three-mesh-bvh of npm: SAH, both sides of triangles, tests in double",
  version: `three-mesh-bvh ${packages.dependencies["three-mesh-bvh"]}, Node ${process.version}`,
};
let bvh, primitives;

/** Returns the bytes of a file in memory, whose size the file system may not state. */
function read(path, from, count) {
  const buffer = Buffer.alloc(count);
  const file = fs.openSync(path, "r");
  let done = 0;
  while (done < count) {
    const got = fs.readSync(file, buffer, done, count - done, from + done);
    if (got === 0) throw new Error(`${path} ends early`);
    done += got;
  }
  fs.closeSync(file);
  return buffer.buffer.slice(buffer.byteOffset, buffer.byteOffset + count);
}

function build(path) {
  const counts = new BigUint64Array(read(path, 8, 40));
  const [vertices, triangles] = [Number(counts[1]), Number(counts[2])];
  const positions = new Float32Array(read(path, 48, 12 * vertices));
  const rows = new Uint32Array(read(path, 48 + 12 * vertices, 16 * triangles));
  const index = new Uint32Array(3 * triangles);
  primitives = new Uint32Array(triangles);
  for (let i = 0; i < triangles; ++i) {
    index.set(rows.subarray(4 * i, 4 * i + 3), 3 * i);
    primitives[i] = rows[4 * i + 3];
  }
  const begin = performance.now();
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  bvh = new MeshBVH(geometry, { strategy: 2, indirect: true }); // SAH; triangles keep their order
  return performance.now() - begin;
}

/** Traces rays with normalized directions, which three.js expects; distances are scaled to t. */
function trace(verb, path, count) {
  const rays = new Float32Array(read(path, 0, 32 * count));
  const begin = performance.now();
  const results = Buffer.alloc((verb === "any" ? 1 : 8) * count);
  const ray = new THREE.Ray();
  for (let i = 0; i < count; ++i) {
    const r = rays.subarray(8 * i, 8 * i + 8);
    ray.origin.set(r[0], r[1], r[2]);
    ray.direction.set(r[4], r[5], r[6]);
    const length = ray.direction.length();
    ray.direction.divideScalar(length);
    const hit = bvh.raycastFirst(ray, THREE.DoubleSide, r[3] * length, r[7] * length);
    if (verb === "any") {
      results.writeUInt8(hit ? 1 : 0, i);
    } else {
      results.writeFloatLE(hit ? hit.distance / length : Infinity, 4 * i);
      results.writeUInt32LE(hit ? primitives[hit.faceIndex] : 0xffffffff, 4 * count + 4 * i);
    }
  }
  const time = performance.now() - begin;
  const file = fs.openSync(path, "r+");
  fs.writeSync(file, results, 0, results.length, 32 * count);
  fs.closeSync(file);
  return time;
}

for await (const line of readline.createInterface({ input: process.stdin })) {
  const [verb, path, count] = line.split(" ");
  let answer = JSON.stringify(description);
  if (verb !== "describe") {
    const time = verb === "build" ? build(path) : trace(verb, path, Number(count));
    answer = `ok ${time / 1000}`;
  }
  process.stdout.write(answer + "\n");
}

// The shapes of a scene and of a structure for three.js.

const DARK = () => matchMedia("(prefers-color-scheme: dark)").matches;

/** The surfaces of a scene; shared by all stages. */
class Surfaces {
  constructor(scene) {
    this.scene = scene;
    const { mesh, spheres } = scene;
    this.material = new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide, flatShading: true,
      transparent: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    this.objects = [];
    const count = mesh.triangles.length;
    if (count > 0) {
      const positions = new Float32Array(3 * count);
      const colors = new Uint8Array(3 * count);
      // Corners are whole numbers in the scene's box.
      const { lower, upper } = scene;
      const part = lower.map((low, axis) => (upper[axis] - low) / 65535);
      for (let i = 0; i < count; ++i) {
        const corner = 3 * mesh.triangles[i];
        for (let axis = 0; axis < 3; ++axis) positions[3 * i + axis] = lower[axis] + mesh.corners[corner + axis] * part[axis];
        colors.set(this.#color(mesh.primitives[Math.floor(i / 3)]), 3 * i);
      }
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
      geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3, true));
      this.positions = positions;
      this.objects.push([geometry, null]);
    }
    if (spheres.primitives.length > 0) {
      const detail = spheres.primitives.length > 2000 ? 1 : spheres.primitives.length > 200 ? 2 : 4;
      this.ball = new THREE.IcosahedronGeometry(1, detail);
      this.ball.setAttribute("color", new THREE.BufferAttribute(new Float32Array(this.ball.attributes.position.count * 3).fill(1), 3));
      this.objects.push([this.ball, spheres]);
    }
  }

  #color(primitive) {
    return this.scene.surfaces[this.scene.surface_of[primitive]].map((part) => 255 * (0.25 + 0.75 * Math.min(part, 1)));
  }

  /** Returns new meshes over the shared geometry: an object of three.js has only one parent. */
  meshes() {
    return this.objects.map(([geometry, spheres]) => {
      if (!spheres) return new THREE.Mesh(geometry, this.material);
      const mesh = new THREE.InstancedMesh(geometry, this.material, spheres.primitives.length);
      spheres.primitives.forEach((primitive, i) => {
        mesh.setMatrixAt(i, this.#placeOfBall(i));
        mesh.setColorAt(i, new THREE.Color(...this.#color(primitive).map((part) => part / 255)));
      });
      return mesh;
    });
  }

  #placeOfBall(i) {
    const [x, y, z, radius] = this.scene.spheres.shapes.subarray(4 * i, 4 * i + 4);
    return new THREE.Matrix4().makeScale(radius, radius, radius).setPosition(x, y, z);
  }

  /** Returns a mesh over some primitives. */
  highlight(primitives, material) {
    const group = new THREE.Group();
    const wanted = new Set(primitives);
    if (wanted.size === 0) return group;
    const corners = [];
    this.scene.mesh.primitives.forEach((primitive, i) => {
      if (wanted.has(primitive)) for (let j = 9 * i; j < 9 * i + 9; ++j) corners.push(this.positions[j]);
    });
    if (corners.length > 0) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
      geometry.computeVertexNormals();
      group.add(new THREE.Mesh(geometry, material));
    }
    this.scene.spheres.primitives.forEach((primitive, i) => {
      if (!wanted.has(primitive)) return;
      const mesh = new THREE.Mesh(this.ball, material);
      mesh.applyMatrix4(this.#placeOfBall(i));
      group.add(mesh);
    });
    return group;
  }
}

const EDGES = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7];

/** Returns the edges of boxes, each given by six numbers: its lower and upper corner. */
function boxEdges(boxes) {
  const positions = new Float32Array((boxes.length / 6) * EDGES.length * 3);
  let at = 0;
  for (let box = 0; box < boxes.length; box += 6) {
    for (const corner of EDGES) {
      for (let axis = 0; axis < 3; ++axis) positions[at++] = boxes[box + axis + ((corner >> axis) & 1 ? 3 : 0)];
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  return geometry;
}

/** Returns a box with faces and edges. */
function glassBox(box, color, opacity) {
  const group = new THREE.Group();
  const size = [0, 1, 2].map((axis) => Math.max(box[axis + 3] - box[axis], 1e-6));
  const faces = new THREE.Mesh(new THREE.BoxGeometry(...size),
    new THREE.MeshBasicMaterial({ color, transparent: true, opacity, depthWrite: false, side: THREE.DoubleSide }));
  faces.position.set(...[0, 1, 2].map((axis) => (box[axis] + box[axis + 3]) / 2));
  group.add(faces, new THREE.LineSegments(boxEdges(box), new THREE.LineBasicMaterial({ color })));
  return group;
}

/** Returns a rod between two points. */
function rod(from, to, radius, color, opacity = 1) {
  const along = to.clone().sub(from);
  const mesh = new THREE.Mesh(new THREE.CylinderGeometry(radius, radius, along.length(), 8, 1),
    new THREE.MeshBasicMaterial({ color, transparent: opacity < 1, opacity }));
  mesh.position.copy(from).addScaledVector(along, 0.5);
  mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.normalize());
  return mesh;
}

/** Returns a pyramid from the eye through corners on the image, given in pixels, to a view depth. */
function pyramid(view, corners, depth, color) {
  const eye = view.eye();
  const ends = [];
  for (let i = 0; i < corners.length; i += 2) ends.push(view.pointAt(corners[i], corners[i + 1], depth));
  const sides = [];
  const lines = [];
  ends.forEach((end, i) => {
    const next = ends[(i + 1) % ends.length];
    sides.push(eye, end, next);
    lines.push(eye, end, end, next);
  });
  const group = new THREE.Group();
  group.add(
    new THREE.Mesh(new THREE.BufferGeometry().setFromPoints(sides),
      new THREE.MeshBasicMaterial({ color, transparent: true, opacity: 0.18, depthWrite: false, side: THREE.DoubleSide })),
    new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(lines), new THREE.LineBasicMaterial({ color })));
  return group;
}

/** Returns the cross-sections of beams where each enters its leaf or leaves the scene. */
function beamSections(view, { kinds, first, corners, depths }, shown, far) {
  const group = new THREE.Group();
  const colors = [COLORS.goesOn, COLORS.occupied, COLORS.leaves];
  for (const kind of [BEAM.goesOn, BEAM.occupied, BEAM.leaves].filter((each) => shown.has(each))) {
    const lines = [];
    const faces = [];
    kinds.forEach((each, beam) => {
      if (each !== kind) return;
      const depth = Math.min(Number.isFinite(depths[beam]) ? depths[beam] : far, far);
      const ends = [];
      for (let i = first[beam]; i < first[beam + 1]; ++i) ends.push(view.pointAt(corners[2 * i], corners[2 * i + 1], depth));
      ends.forEach((end, i) => lines.push(end, ends[(i + 1) % ends.length]));
      for (let i = 2; i < ends.length; ++i) faces.push(ends[0], ends[i - 1], ends[i]);
    });
    group.add(new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(lines),
      new THREE.LineBasicMaterial({ color: colors[kind], transparent: true, opacity: kind === BEAM.goesOn ? 0.5 : 1 })));
    if (kind === BEAM.goesOn) continue;
    group.add(new THREE.Mesh(new THREE.BufferGeometry().setFromPoints(faces),
      new THREE.MeshBasicMaterial({ color: colors[kind], transparent: true, opacity: 0.35, depthWrite: false, side: THREE.DoubleSide })));
  }
  return group;
}

/** Returns points with colors, each `size` pixels wide. */
function coloredPoints(points, colors, size) {
  const geometry = new THREE.BufferGeometry().setFromPoints(points);
  geometry.setAttribute("color", new THREE.Float32BufferAttribute(colors, 3));
  return new THREE.Points(geometry, new THREE.PointsMaterial({ size, sizeAttenuation: false, vertexColors: true }));
}

// A stage: the scene in 3D, with one structure over it.

/** The view of the image, which computes points on its rays. */
class ImageView {
  constructor(image) {
    this.image = image;
    [this.from, this.corner, this.right, this.down] =
      [image.eye, image.top_left, image.right, image.down].map((v) => new THREE.Vector3(...v));
  }
  eye() { return this.from.clone(); }
  direction(px, py) {
    return this.corner.clone().addScaledVector(this.right, px).addScaledVector(this.down, py);
  }
  pointAt(px, py, t) { return this.eye().addScaledVector(this.direction(px, py), t); }
}

/** The camera and the surfaces that all stages share. */
class SharedView {
  constructor(data) {
    this.image = new ImageView(data.image);
    this.surfaces = new Surfaces(data.scene);
    this.lower = new THREE.Vector3(...data.scene.lower);
    this.upper = new THREE.Vector3(...data.scene.upper);
    this.center = this.lower.clone().add(this.upper).multiplyScalar(0.5);
    this.radius = Math.max(this.upper.clone().sub(this.lower).length() / 2, 1e-6);
    const distance = this.image.eye().distanceTo(this.center);
    this.far = distance + 1.1 * this.radius;
    this.camera = new THREE.PerspectiveCamera(45, 1, this.radius / 500, distance + 40 * this.radius);
    this.camera.up.set(...data.image.up);
    this.angle = data.image.angle;
    this.target = new THREE.Vector3();
    this.stages = [];
    this.lookFromOutside();
  }

  /** Looks from the side and above, so that both the eye and the scene are seen. */
  lookFromOutside() {
    const eye = this.image.eye();
    const seen = new THREE.Box3(this.lower, this.upper).expandByPoint(eye);
    const size = seen.getSize(new THREE.Vector3()).length() / 2;
    seen.getCenter(this.target);
    const forward = new THREE.Vector3(...this.image.image.forward);
    const up = this.camera.up.clone().normalize();
    const side = forward.clone().cross(up).normalize();
    const along = side.multiplyScalar(0.75).addScaledVector(up, 0.6).addScaledVector(forward, -0.55).normalize();
    [this.fov, this.aspect] = [40, 1.3];
    this.camera.position.copy(this.target).addScaledVector(along, 2.9 * size);
    this.#moved();
  }

  lookFromEye() {
    const forward = new THREE.Vector3(...this.image.image.forward);
    const eye = this.image.eye();
    const distance = Math.max(eye.distanceTo(this.center), this.radius / 10);
    [this.fov, this.aspect] = [this.angle, this.image.image.width / this.image.image.height];
    this.camera.position.copy(eye);
    this.target.copy(eye).addScaledVector(forward, distance);
    this.#moved();
  }

  #moved() {
    this.camera.lookAt(this.target);
    for (const stage of this.stages) stage.controls.update();
    this.draw();
  }
  draw() { for (const stage of this.stages) stage.draw(); }
}

class Stage {
  constructor(holder, shared, structure) {
    this.shared = shared;
    this.structure = structure;
    this.renderer = new THREE.WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    holder.append(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(DARK() ? "#1d2127" : "#f4f5f7");
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f98, 0.75));
    this.lamp = new THREE.DirectionalLight(0xffffff, 0.45);
    this.scene.add(this.lamp, this.lamp.target, ...shared.surfaces.meshes());
    this.cells = this.#group();
    this.extra = this.#group();
    this.ray = this.#group();
    this.scene.add(new THREE.Mesh(new THREE.SphereGeometry(shared.radius / 60, 12, 8),
      new THREE.MeshBasicMaterial({ color: 0x888888 })).translateX(0));
    this.scene.children.at(-1).position.copy(shared.image.eye());
    this.controls = new THREE.OrbitControls(shared.camera, this.renderer.domElement);
    this.controls.target = shared.target;  // the controls began with a target of their own
    this.controls.update();
    this.controls.addEventListener("change", () => shared.draw());
    shared.stages.push(this);
    new ResizeObserver(() => {
      this.renderer.setSize(holder.clientWidth, holder.clientHeight);
      this.draw();
    }).observe(holder);
  }

  #group() {
    const group = new THREE.Group();
    this.scene.add(group);
    return group;
  }

  /** Draws once in the next frame. */
  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      const { width, height } = this.renderer.domElement;
      const { camera } = this.shared;
      camera.aspect = width / Math.max(height, 1);
      // On a narrow stage, widens the view so that everything still fits.
      const wider = Math.max(1, this.shared.aspect / camera.aspect);
      camera.fov = (360 / Math.PI) * Math.atan(wider * Math.tan((this.shared.fov * Math.PI) / 360));
      camera.updateProjectionMatrix();
      this.lamp.position.copy(camera.position);
      this.lamp.target.position.copy(this.shared.target);
      this.renderer.render(this.scene, camera);
    });
  }

  #replace(group, objects) {
    group.traverse((object) => { if (object !== group && object.geometry !== this.shared.surfaces.ball) object.geometry?.dispose(); });
    group.clear();
    if (objects.length > 0) group.add(...objects);
    this.draw();
  }

  /** Shows the cells of a level; 0 for none, one more than the last for all. */
  showLevel(level, last) {
    const { boxes, levels } = this.structure.cells;
    const chosen = [];
    levels.forEach((each, i) => {
      if (level !== 0 && (each === level || level > last)) for (let j = 6 * i; j < 6 * i + 6; ++j) chosen.push(boxes[j]);
    });
    const color = DARK() ? "#7fd1a8" : "#0a7d55";
    const material = new THREE.LineBasicMaterial({ color, transparent: true, opacity: chosen.length > 6000 ? 0.25 : 0.55 });
    this.#replace(this.cells, chosen.length > 0 ? [new THREE.LineSegments(boxEdges(chosen), material)] : []);
  }

  /** Shows the content of a map mode in the scene. */
  showMap(mode, shown) {
    const objects = [];
    const { image, far } = this.shared;
    if (shown && mode.outlines) objects.push(beamSections(image, mode.outlines, mode.shown, far));
    if (shown && !mode.outlines) {
      const points = [];
      const colors = [];
      const { width } = image.image;
      const add = (point, ray) => {
        const color = new THREE.Color(mode.color(ray).slice(0, 7) === "#000000" ? "#888888" : mode.color(ray));
        points.push(point);
        colors.push(color.r, color.g, color.b);
      };
      if (mode.pencil) {
        mode.pencil.pixels.forEach((pixel, i) => add(new THREE.Vector3(...mode.pencil.origins.subarray(3 * i, 3 * i + 3)), pixel));
        objects.push(this.#lightOf(mode.pencil));
      } else {
        this.structure.hits.t.forEach((t, ray) => {
          if (Number.isFinite(t)) add(image.pointAt((ray % width) + 0.5, Math.floor(ray / width) + 0.5, t), ray);
        });
      }
      if (points.length > 0) objects.push(coloredPoints(points, colors, 3));
    }
    this.#replace(this.extra, objects);
  }

  #lightOf(pencil) {
    const lamp = new THREE.Mesh(new THREE.SphereGeometry(this.shared.radius / 40, 12, 8), new THREE.MeshBasicMaterial({ color: "#f0c000" }));
    lamp.position.copy(this.light(pencil));
    return lamp;
  }
  light(pencil) { return new THREE.Vector3(...this.lights[pencil.light]); }

  /** Shows the ray of a pixel after some of its steps. */
  showRay(pixel, steps, at, mode) {
    const { image, radius, far, surfaces } = this.shared;
    const [px, py] = [pixel.x + 0.5, pixel.y + 0.5];
    const thick = radius / 200;
    const objects = [];
    const step = steps[at];
    const end = pixel.hit ? pixel.t : far;
    objects.push(rod(image.eye(), image.pointAt(px, py, Math.min(end, far)), thick / 2, "#8b949e", 0.6));
    steps.slice(0, at).forEach((each) => {
      if (each.box) objects.push(new THREE.LineSegments(boxEdges(each.box), new THREE.LineBasicMaterial({ color: "#8b949e", transparent: true, opacity: 0.5 })));
    });
    if (step?.box) objects.push(glassBox(step.box, step.beam ? [COLORS.goesOn, COLORS.occupied, COLORS.leaves][step.beam.kind] : "#d55e00", 0.13));
    if (step?.beam) {
      const cell = this.#depths(step.box, px, py);
      const depth = step.beam.kind === BEAM.leaves ? far : Math.min(cell.enter, far);
      objects.push(pyramid(image, step.beam.corners, depth, [COLORS.order, COLORS.occupied, COLORS.leaves][step.beam.kind]));
    } else if (step) {
      const from = Math.min(step.enter, end);
      const to = Math.min(step.exit, end, far);
      if (to > from) objects.push(rod(image.pointAt(px, py, from), image.pointAt(px, py, to), thick * 1.4, "#d55e00"));
      const tested = new THREE.MeshBasicMaterial({ color: "#4da3e0", transparent: true, opacity: 0.5, side: THREE.DoubleSide, depthWrite: false });
      const met = new THREE.MeshBasicMaterial({ color: "#e69f00", transparent: true, opacity: 0.9, side: THREE.DoubleSide });
      const best = step.best?.primitive;
      objects.push(surfaces.highlight(step.tests.map((test) => test.primitive).filter((id) => id !== best), tested));
      if (best !== undefined) objects.push(surfaces.highlight([best], met));
    }
    if (pixel.hit && (!step || (step.best && step.best.t === pixel.t))) {
      const mark = new THREE.Mesh(new THREE.SphereGeometry(radius / 90, 14, 10), new THREE.MeshBasicMaterial({ color: "#d00000" }));
      mark.position.copy(image.pointAt(px, py, pixel.t));
      objects.push(mark);
    }
    objects.push(...this.#bundle(pixel, mode, end));
    this.#replace(this.ray, objects);
  }

  /** Returns the tile of the selected pixel, or the shadow rays of its block. */
  #bundle(pixel, mode, depth) {
    const { image, far } = this.shared;
    const { width, height } = image.image;
    const ray = pixel.y * width + pixel.x;
    if (mode.pencil) {
      const { place, pencil } = mode;
      if (place[ray] < 0) return [];
      const lines = [];
      pencil.blocks.forEach((block, i) => {
        if (block !== pencil.blocks[place[ray]]) return;
        lines.push(new THREE.Vector3(...pencil.origins.subarray(3 * i, 3 * i + 3)), this.light(pencil));
      });
      return [new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(lines), new THREE.LineBasicMaterial({ color: "#d55e00" }))];
    }
    if (!mode.borders) return [];
    let [left, top, right, bottom] = [width, height, 0, 0];
    mode.borders.forEach((beam, i) => {
      if (beam !== mode.borders[ray]) return;
      const [x, y] = [i % width, Math.floor(i / width)];
      [left, top, right, bottom] = [Math.min(left, x), Math.min(top, y), Math.max(right, x + 1), Math.max(bottom, y + 1)];
    });
    return [pyramid(image, [left, top, right, top, right, bottom, left, bottom], Math.min(depth, far), COLORS.order)];
  }

  /** Returns the depths between which the ray of a pixel is in a box. */
  #depths(box, px, py) {
    const eye = this.shared.image.eye();
    const direction = this.shared.image.direction(px, py);
    let [enter, exit] = [0, this.shared.far];
    ["x", "y", "z"].forEach((axis, i) => {
      const [a, b] = [box[i], box[i + 3]].map((plane) => (plane - eye[axis]) / direction[axis]);
      enter = Math.max(enter, Math.min(a, b));
      exit = Math.min(exit, Math.max(a, b));
    });
    return { enter, exit };
  }
}

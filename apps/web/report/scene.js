// The three-dimensional view: members as prisms, panels, supports, reactions, force diagrams. One mesh of each kind, remade
// in place when what is shown changes; drawn only when something moved.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { Labels } from './labels.js';
import { bounds, memberLine } from './shape.js';

const CORNERS = [[-1, -1], [1, -1], [1, 1], [-1, 1]];

export class StructureView {
  constructor(canvas, model) {
    this.model = model;
    this.bounds = bounds(model.nodes);
    // Many members: fewer pieces for each, so that a change of scale stays quick.
    this.segments = model.members.length > 4000 ? 4 : 10;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setClearColor(0xf4f7fa);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(40, 1, this.bounds.size / 1000, this.bounds.size * 20);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.raycaster = new THREE.Raycaster();
    this.labels = new Labels(canvas);
    this.#addLights();
    this.#addMembers();
    this.#addLines();
    this.#addPanels();
    this.#addSupports();
    this.#addAxes();
    this.diagram = this.#emptyMesh(new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide, transparent: true, opacity: 0.75 }));
    this.arrows = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x7a2fb5 }));
    this.scene.add(this.arrows);
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    this.#resize();
  }

  /** Looks from the south-east, from above, so that all of the structure and its arrows are in view. */
  home() {
    const [x, y, z] = this.bounds.centre;
    const half = Math.tan(this.camera.fov / 2 * Math.PI / 180) * Math.min(1, this.camera.aspect);
    const direction = new THREE.Vector3(0.6, -0.8, 0.4).normalize();
    const right = new THREE.Vector3(0, 0, 1).cross(direction).normalize(), up = direction.clone().cross(right);
    // Each corner of the box wants a distance at which it is inside of the picture; the margin is for arrows and labels.
    let distance = 0;
    for (let k = 0; k < 8; ++k) {
      const corner = new THREE.Vector3(...[0, 1, 2].map((i) => (k >> i & 1 ? this.bounds.high[i] : this.bounds.low[i]) - this.bounds.centre[i]));
      const across = Math.max(Math.abs(corner.dot(right)) / Math.max(1, this.camera.aspect), Math.abs(corner.dot(up)));
      distance = Math.max(distance, corner.dot(direction) + 1.2 * across / half);
    }
    this.camera.position.set(x, y, z).addScaledVector(direction, Math.max(distance, 0.1 * this.bounds.size));
    this.controls.target.set(x, y, z);
    this.controls.update();
  }

  draw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      this.renderer.render(this.scene, this.camera);
      this.labels.place(this.camera);
    });
  }

  /** movements: per node six numbers, or null; scale: factor on them; bows: per member its deflections (memberLine), or null. */
  setShape(movements, scale, bows = null) {
    this.movements = movements;
    this.bows = bows;
    this.scale = scale;
    this.#placeMembers();
    this.#placePanels();
    this.draw();
  }

  /** colour(member index, station index 0..segments) -> [r, g, b] */
  setColours(colour) {
    const colours = this.members.geometry.attributes.color;
    const rings = this.segments + 1;
    for (let m = 0; m < this.model.members.length; ++m)
      for (let k = 0; k < rings; ++k) {
        const [r, g, b] = colour(m, k);
        for (let c = 0; c < 4; ++c) colours.setXYZ((m * rings + k) * 4 + c, r, g, b);
      }
    colours.needsUpdate = true;
    this.draw();
  }

  /** values: per member an array of values at even stations (or null); axis 1 (y) or 2 (z) is drawn along. */
  setDiagram(values, axis, colour) {
    const positions = [], colours = [];
    if (values) {
      let largest = 0;
      for (const list of values) if (list) for (const v of list) largest = Math.max(largest, Math.abs(v));
      const reach = largest > 0 ? 0.06 * this.bounds.size / largest : 0;
      this.model.members.forEach((member, m) => {
        const list = values[m];
        if (!list) return;
        const line = memberLine(member, this.model.nodes, this.movements, this.scale, list.length - 1, this.bows?.[m]);
        const tip = (k) => line[k].map((p, i) => p + member.axes[axis][i] * list[k] * reach);
        for (let k = 0; k + 1 < list.length; ++k) {
          const a = line[k], b = line[k + 1], c = tip(k + 1), d = tip(k);
          positions.push(...a, ...b, ...c, ...a, ...c, ...d);
          const left = colour(list[k] / largest), right = colour(list[k + 1] / largest);
          colours.push(...left, ...right, ...right, ...left, ...right, ...left);
        }
      });
    }
    this.#fill(this.diagram.geometry, positions, colours);
    this.draw();
  }

  /** Texts at nodes, where the drawn shape has them: [{node, text}]. */
  setNodeLabels(group, list) {
    this.labels.set(group, list.map(({ node, text }) => ({ at: this.#drawn(node), text })));
    this.draw();
  }

  /** reactions: list of {node, force: [x, y, z], text} */
  setArrows(reactions) {
    const largest = Math.max(0, ...reactions.map((r) => Math.hypot(...r.force)));
    const positions = [], labels = [];
    for (const { node, force, text } of reactions) {
      const size = Math.hypot(...force);
      if (size < 1e-9 * largest || largest === 0) continue;
      const head = this.model.nodes[node];
      const length = this.bounds.size * (0.02 + 0.10 * size / largest);
      const dir = force.map((f) => f / size);
      const tail = head.map((p, i) => p - dir[i] * length);
      labels.push({ at: tail, text, size });
      const side = Math.abs(dir[2]) < 0.9 ? [-dir[1], dir[0], 0] : [1, 0, 0];
      positions.push(...tail, ...head);
      for (const s of [-1, 1])
        positions.push(...head, ...head.map((p, i) => p - dir[i] * length * 0.2 + s * side[i] * length * 0.08));
    }
    this.arrows.geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
    this.arrows.geometry.computeBoundingSphere();
    this.labels.set('reaction', labels.sort((a, b) => b.size - a.size));
    this.draw();
  }

  setPanelsVisible(visible) {
    this.panels.visible = visible;
    this.draw();
  }

  /** Index of the member under a point of the canvas (-1 to 1), or null. */
  pick(x, y) {
    this.raycaster.setFromCamera(new THREE.Vector2(x, y), this.camera);
    const hit = this.raycaster.intersectObject(this.members, false)[0];
    return hit ? Math.floor(hit.faceIndex / (this.segments * 8)) : null;
  }

  #addLights() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xb8c0c8, 2.2));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(0.4, -0.7, 1);
    this.scene.add(sun);
    const s = this.bounds.size * 1.5;
    const grid = new THREE.GridHelper(s, 20, 0xc4ccd4, 0xdde3e8);
    grid.rotation.x = Math.PI / 2;
    grid.position.set(this.bounds.centre[0], this.bounds.centre[1], this.bounds.low[2]);
    this.scene.add(grid);
  }

  #emptyMesh(material) {
    const mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    mesh.frustumCulled = false;
    this.scene.add(mesh);
    return mesh;
  }

  #fill(geometry, positions, colours) {
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
    geometry.setAttribute('color', new THREE.Float32BufferAttribute(colours, 3));
  }

  #addMembers() {
    const count = this.model.members.length, rings = this.segments + 1;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(count * rings * 12), 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(count * rings * 12), 3));
    const index = new Uint32Array(count * this.segments * 24);
    let at = 0;
    for (let m = 0; m < count; ++m)
      for (let k = 0; k < this.segments; ++k)
        for (let c = 0; c < 4; ++c) {
          const a = (m * rings + k) * 4 + c, b = (m * rings + k) * 4 + (c + 1) % 4;
          index.set([a, a + 4, b, b, a + 4, b + 4], at);
          at += 6;
        }
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    this.members = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide, flatShading: true }));
    this.members.frustumCulled = false;
    this.scene.add(this.members);
    this.#placeMembers();
  }

  #placeMembers() {
    const position = this.members.geometry.attributes.position;
    const rings = this.segments + 1;
    this.model.members.forEach((member, m) => {
      const line = memberLine(member, this.model.nodes, this.movements, this.scale, this.segments, this.bows?.[m]);
      const [, y, z] = member.axes;
      for (let k = 0; k < rings; ++k)
        for (let c = 0; c < 4; ++c) {
          const dy = CORNERS[c][0] * member.width / 2, dz = CORNERS[c][1] * member.depth / 2;
          position.setXYZ((m * rings + k) * 4 + c, line[k][0] + y[0] * dy + z[0] * dz, line[k][1] + y[1] * dy + z[1] * dz, line[k][2] + y[2] * dy + z[2] * dz);
        }
    });
    position.needsUpdate = true;
    this.members.geometry.computeBoundingSphere();
  }

  /** Members of a large building that the report does not hold. */
  #addLines() {
    const lines = this.model.lines ?? [];
    if (!lines.length) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(lines.flatMap((n) => this.model.nodes[n])), 3));
    this.scene.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0x8fa3b5, transparent: true, opacity: 0.25 })));
  }

  #addPanels() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(this.model.panels.length * 18), 3));
    this.panels = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ color: 0x8fa3b5, transparent: true, opacity: 0.22, side: THREE.DoubleSide, depthWrite: false }));
    this.panels.frustumCulled = false;
    this.scene.add(this.panels);
    this.#placePanels();
  }

  #placePanels() {
    const position = this.panels.geometry.attributes.position;
    this.model.panels.forEach((panel, p) => {
      const corners = panel.nodes.map((n) => this.#drawn(n));
      [0, 1, 2, 0, 2, 3].forEach((c, k) => position.setXYZ(6 * p + k, ...corners[c]));
    });
    position.needsUpdate = true;
  }

  #addSupports() {
    const s = this.bounds.size * 0.008;
    const geometry = new THREE.ConeGeometry(s, 2 * s, 4);
    geometry.rotateX(Math.PI / 2);
    geometry.translate(0, 0, -s);
    const mesh = new THREE.InstancedMesh(geometry, new THREE.MeshLambertMaterial({ color: 0x3d4854 }), Math.max(1, this.model.supports.length));
    mesh.count = this.model.supports.length;
    this.model.supports.forEach((node, k) => mesh.setMatrixAt(k, new THREE.Matrix4().makeTranslation(...this.model.nodes[node])));
    mesh.frustumCulled = false;
    this.scene.add(mesh);
  }

  /** Global axes, drawn aside of the lowest corner. */
  #addAxes() {
    const size = 0.1 * this.bounds.size;
    const corner = [this.bounds.low[0] - size, this.bounds.low[1] - size, this.bounds.low[2]];
    const axes = new THREE.AxesHelper(size);
    axes.position.set(...corner);
    this.scene.add(axes);
    this.labels.set('axis', ['x', 'y', 'z'].map((text, i) => ({ at: corner.map((v, j) => (i === j ? v + 1.15 * size : v)), text })));
  }

  #drawn(node) {
    return this.model.nodes[node].map((v, i) => v + (this.movements ? this.scale * (this.movements[node]?.[i] ?? 0) : 0));
  }

  #resize() {
    const box = this.renderer.domElement.parentElement.getBoundingClientRect();
    if (box.width < 1 || box.height < 1) return;
    this.renderer.setSize(box.width, box.height, false);
    this.camera.aspect = box.width / box.height;
    this.camera.updateProjectionMatrix();
    if (!this.placed) this.home();
    this.placed = true;
    this.draw();
  }
}

// A run seen again: to turn, to scrub, to play slowly. One page, no network; the data stand in it as JSON.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { GONE, STANDS, Shape, Track, floats, geometry, integers, lastNotAbove } from './data.js';

const MEMBER_COLOURS = [0x5c6a7a, 0x8c98a4, 0xa4785c], PANEL_COLOURS = [0xcec8be, 0xdecdb4], PIECE_COLOURS = [...PANEL_COLOURS, ...MEMBER_COLOURS], DRAWN_COLOUR = 0xd6c8b0, FAILED = new THREE.Color(0x1e4ee8);
// tool, impact, yielded, broke, fractured, mechanism, detached, split, at rest, limited, done
const EVENT_COLOURS = ['#d9822b', '#444', '#2f6fde', '#2f6fde', '#2f6fde', '#c23030', '#c23030', '#c23030', '#3a9a3a', '#999', '#3a9a3a'];
const byId = (id) => document.getElementById(id);

class Replay {
  constructor(data) {
    this.data = data;
    this.times = floats(data.times);
    this.tracks = data.tracks.map((track) => new Track(track));
    this.shapes = new Map(data.shapes.map((shape) => [shape.part, new Shape(shape)]));
    this.#stage();
    this.#members();
    this.#panels();
    this.#bodies();
    this.#drawn();
    this.#places();
    this.#failed();
  }

  #stage() {
    const canvas = byId('canvas'), r = this.data.radius;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0xcfe0f0);
    this.scene.fog = new THREE.Fog(0xcfe0f0, 6 * r, 24 * r);
    this.scene.add(new THREE.HemisphereLight(0xe8f1ff, 0x8a8275, 1.5));
    const sun = new THREE.DirectionalLight(0xfff2dd, 2.4);
    sun.position.set(-0.34, -0.56, 0.75).multiplyScalar(3 * r);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    Object.assign(sun.shadow.camera, { left: -2 * r, right: 2 * r, top: 2 * r, bottom: -2 * r, far: 8 * r });
    sun.shadow.bias = -0.0004;
    sun.shadow.normalBias = 0.03;
    this.scene.add(sun);
    const ground = new THREE.Mesh(new THREE.PlaneGeometry(80 * r, 80 * r), new THREE.MeshLambertMaterial({ color: 0xb2b0a6 }));
    ground.position.z = this.data.ground;
    ground.receiveShadow = true;
    this.scene.add(ground);
    this.camera = new THREE.PerspectiveCamera(40, 1, r / 200, 60 * r);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(0.55, -0.78, 0.32).normalize().multiplyScalar(3.4 * r);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = 1.55;
    this.controls.addEventListener('change', () => this.draw());
    addEventListener('resize', () => this.#resize());
    this.#resize();
  }

  #resize() {
    this.renderer.setSize(innerWidth, innerHeight, false);
    this.camera.aspect = innerWidth / innerHeight;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  #instanced(shape, count, colour, opacity = 1) {
    const material = new THREE.MeshLambertMaterial({ color: colour, transparent: opacity < 1, opacity, side: opacity < 1 ? THREE.DoubleSide : THREE.FrontSide });
    const mesh = new THREE.InstancedMesh(shape, material, count);
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    this.scene.add(mesh);
    return mesh;
  }

  #members() {
    // Those that bend share meshes of their own, by section and length; the others are drawn by their section, stretched.
    const sections = [...this.data.sections, ...this.data.bent].map(geometry), counts = sections.map(() => 0), straight = this.data.sections.length;
    for (const member of this.data.members) {
      member.batch = member.bent === undefined ? member.section : straight + member.bent;
      member.instance = counts[member.batch]++;
    }
    this.batches = sections.map((shape, s) => (counts[s] ? this.#instanced(shape, counts[s], 0xffffff) : null));
    this.members = this.data.members.map(({ batch, bent, kind, instance, numbers }, m) => {
      const [x, y, z, length, ...axes] = floats(numbers);
      const along = new THREE.Vector3(...axes.slice(0, 3)), place = new THREE.Vector3(x, y, z);
      if (bent === undefined) along.multiplyScalar(length);
      else place.addScaledVector(along, length / 2);
      const rest = new THREE.Matrix4().makeBasis(along, new THREE.Vector3(...axes.slice(3, 6)), new THREE.Vector3(...axes.slice(6, 9))).setPosition(place);
      return { batch: this.batches[batch], instance, rest, bends: bent !== undefined, shape: this.shapes.get(m), colour: new THREE.Color(MEMBER_COLOURS[kind]) };
    });
  }

  #panels() {
    this.panels = this.data.panels.map(({ kind, states }, p) => {
      const opacity = kind === 1 ? 0.45 : 1;
      const panel = new THREE.Mesh(geometry(states[0].mesh), new THREE.MeshLambertMaterial({ color: PANEL_COLOURS[kind], transparent: opacity < 1, opacity }));
      panel.castShadow = panel.receiveShadow = true;
      panel.matrixAutoUpdate = false;
      panel.frames = states.map(({ frame }) => frame);
      panel.shapes = states.map(({ mesh }, k) => (k === 0 ? panel.geometry : geometry(mesh)));
      panel.shape = this.shapes.get(this.members.length + p);
      this.scene.add(panel);
      return panel;
    });
  }

  #bodies() {
    const ball = new THREE.SphereGeometry(1, 24, 16);
    for (const track of this.tracks) {
      if (!track.radius && !track.chunk) continue;
      track.mesh = new THREE.Mesh(track.chunk ? geometry(track.chunk) : ball, new THREE.MeshLambertMaterial({ color: track.chunk ? PIECE_COLOURS[track.kind] : 0x3a3436 }));
      track.mesh.castShadow = track.mesh.receiveShadow = true;
      if (track.radius) track.mesh.scale.setScalar(track.radius);
      this.scene.add(track.mesh);
    }
  }

  /** Pieces of a model around the building, each with its places: [frame, track, frame, track ...]. */
  #drawn() {
    this.drawn = this.data.drawn.map(({ mesh, places }) => {
      const piece = new THREE.Mesh(geometry(mesh), new THREE.MeshLambertMaterial({ color: DRAWN_COLOUR }));
      piece.castShadow = piece.receiveShadow = true;
      piece.matrixAutoUpdate = false;
      piece.places = integers(places);
      this.scene.add(piece);
      return piece;
    });
    byId('drawn').parentElement.hidden = this.drawn.length === 0;
  }

  /** Per part its places: [frame, track, frame, track ...], standing at first. */
  #places() {
    this.places = Array.from({ length: this.members.length + this.panels.length }, () => [-1, STANDS]);
    const changes = integers(this.data.places);
    for (let i = 0; i < changes.length; i += 3) this.places[changes[i]].push(changes[i + 1], changes[i + 2]);
  }

  #failed() {
    const list = integers(this.data.failed);
    this.members.forEach((member) => { member.failed = Infinity; });
    for (let i = 0; i < list.length; i += 3) this.members[list[i]].failed = Math.min(this.members[list[i]].failed, list[i + 2]);
  }

  get end() { return this.times[this.times.length - 1]; }

  /** Frame (a real number) of a time. */
  frameAt(time) {
    const k = Math.max(0, lastNotAbove(this.times, time));
    if (k + 1 >= this.times.length) return this.times.length - 1;
    return k + Math.min(1, Math.max(0, (time - this.times[k]) / (this.times[k + 1] - this.times[k])));
  }

  show(time) {
    const frame = this.frameAt(time), whole = Math.floor(frame);
    for (const track of this.tracks) {
      const alive = track.alive(whole);
      if (alive) track.place(frame);
      if (!track.mesh) continue;
      track.mesh.visible = alive;
      track.mesh.position.copy(track.centre).add(track.offset);
      track.mesh.quaternion.copy(track.turn);
    }
    const nothing = new THREE.Matrix4().makeScale(0, 0, 0), moved = new THREE.Matrix4();
    const placeOf = (part, at = whole) => this.places[part][2 * lastNotAbove(this.places[part], at, 2) + 1];
    /** Where the part is, from where it was undeformed; sets how its shape is bent. */
    const motionOf = (part, place, shape) => {
      if (place >= 0) moved.copy(this.tracks[place].matrix);
      else moved.identity();
      if (!shape) return moved;
      shape.place(frame, placeOf(part, whole + 1) === place);
      return moved.multiply(shape.matrix);
    };
    let standing = 0;
    this.members.forEach((member, m) => {
      const place = placeOf(m);
      if (place === STANDS) ++standing;
      member.batch.setMatrixAt(member.instance, place === GONE ? nothing : motionOf(m, place, member.shape).multiply(member.rest));
      if (member.bends) member.batch.setMorphAt(member.instance, { morphTargetInfluences: member.shape.bend });
      member.batch.setColorAt(member.instance, member.failed <= whole ? member.colour.clone().lerp(FAILED, 0.55) : member.colour);
    });
    for (const batch of this.batches) {
      if (!batch) continue;
      batch.instanceMatrix.needsUpdate = true;
      batch.instanceColor.needsUpdate = true;
      if (batch.morphTexture) batch.morphTexture.needsUpdate = true;
    }
    this.panels.forEach((panel, p) => {
      const place = placeOf(this.members.length + p);
      panel.visible = place !== GONE && byId('panels').checked;
      panel.geometry = panel.shapes[Math.max(0, lastNotAbove(panel.frames, whole))];
      if (place !== GONE) panel.matrix.copy(motionOf(this.members.length + p, place, panel.shape));
      if (panel.geometry.morphAttributes.position) panel.morphTargetInfluences = panel.shape.bend.slice(0, panel.geometry.morphAttributes.position.length);
      panel.matrixWorldNeedsUpdate = true;
    });
    for (const piece of this.drawn) {
      const place = piece.places[2 * lastNotAbove(piece.places, whole, 2) + 1];
      piece.visible = place !== GONE && byId('drawn').checked;
      if (place >= 0) piece.matrix.copy(this.tracks[place].matrix);
      else piece.matrix.identity();
      piece.matrixWorldNeedsUpdate = true;
    }
    byId('state').textContent = `${standing} of ${this.members.length} members stand`;
    this.draw();
  }

  draw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      this.renderer.render(this.scene, this.camera);
    });
  }
}

class Player {
  constructor(replay, events) {
    this.replay = replay;
    this.events = events;
    this.slider = byId('time');
    this.slider.max = replay.end;
    this.slider.addEventListener('input', () => this.#go(Number(this.slider.value)));
    byId('play').addEventListener('click', () => this.#toggle());
    for (const shown of ['panels', 'drawn']) byId(shown).addEventListener('change', () => this.#go(this.time));
    addEventListener('keydown', (event) => {
      if (event.code !== 'Space' || event.target.tagName === 'BUTTON') return;
      event.preventDefault();
      this.#toggle();
    });
    this.#marks();
    this.#go(0);
  }

  #marks() {
    let last = '';
    for (const { time, kind } of this.events) {
      const at = `${(100 * time / this.replay.end).toFixed(1)}%`, colour = EVENT_COLOURS[kind];
      if (last === at + colour) continue;
      last = at + colour;
      const mark = document.createElement('i');
      mark.style.left = at;
      mark.style.background = colour;
      byId('marks').append(mark);
    }
  }

  #go(time) {
    this.time = Math.min(Math.max(time, 0), this.replay.end);
    this.slider.value = this.time;
    byId('clock').textContent = `${this.time.toFixed(2)} / ${this.replay.end.toFixed(2)} s`;
    const near = this.events.filter((event) => event.time <= this.time && event.time > this.time - 0.6);
    byId('event').textContent = near.slice(-4).map((event) => `${event.time.toFixed(2)} s  ${event.text}`).join('\n');
    this.replay.show(this.time);
  }

  #toggle() {
    this.playing = !this.playing;
    byId('play').textContent = this.playing ? 'Pause' : 'Play';
    if (!this.playing) return;
    if (this.time >= this.replay.end) this.#go(0);
    this.last = performance.now();
    requestAnimationFrame((now) => this.#tick(now));
  }

  #tick(now) {
    if (!this.playing) return;
    this.#go(this.time + (now - this.last) / 1000 * Number(byId('speed').value));
    this.last = now;
    if (this.time >= this.replay.end) return this.#toggle();
    requestAnimationFrame((next) => this.#tick(next));
  }
}

const data = JSON.parse(byId('data').textContent);
byId('title').textContent = data.title;
document.title = `${data.title} - Topple replay`;
new Player(new Replay(data), data.events);
document.body.dataset.ready = 'yes';

// The recorded run as the page carries it: see html_replay.cpp.
import * as THREE from 'three';

function bytes(base64) {
  const text = atob(base64), out = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) out[i] = text.charCodeAt(i);
  return out.buffer;
}
export const floats = (base64) => new Float32Array(bytes(base64));
export const integers = (base64) => new Int32Array(bytes(base64));

/** One that bends has its ways of bending as morph targets, of places and of normals. */
export function geometry({ positions, normals, indices, bends, turns }) {
  const result = new THREE.BufferGeometry();
  result.setAttribute('position', new THREE.BufferAttribute(floats(positions), 3));
  result.setAttribute('normal', new THREE.BufferAttribute(floats(normals), 3));
  result.setIndex(new THREE.BufferAttribute(new Uint32Array(bytes(indices)), 1));
  if (bends) {
    const size = result.attributes.position.array.length;
    const targets = (ways) => Array.from({ length: ways.length / size }, (_, k) => new THREE.BufferAttribute(ways.subarray(k * size, (k + 1) * size), 3));
    result.morphTargetsRelative = true;
    result.morphAttributes.position = targets(floats(bends));
    if (turns) result.morphAttributes.normal = targets(floats(turns));
  }
  return result;
}

export const STANDS = -1, GONE = -2;

/** Index of the last of the sorted values that is not above x; -1 when all are. */
export function lastNotAbove(values, x, stride = 1, offset = 0) {
  let low = 0, high = values.length / stride;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle * stride + offset] <= x) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** One body: where it is at a frame (a real number). */
export class Track {
  constructor({ centre, first, end, frames, poses, radius, chunk, kind }) {
    Object.assign(this, { first, end, radius, chunk, kind });
    this.centre = new THREE.Vector3(...centre);
    this.frames = integers(frames);
    this.poses = floats(poses);
    this.offset = new THREE.Vector3();
    this.turn = new THREE.Quaternion();
    this.matrix = new THREE.Matrix4();
  }
  alive(frame) { return frame >= this.first && (this.end < 0 || frame < this.end); }
  /** Sets offset, turn, and the matrix that moves points of the undeformed building. */
  place(frame) {
    const k = Math.max(0, lastNotAbove(this.frames, frame)), next = Math.min(k + 1, this.frames.length - 1);
    const share = next > k ? Math.min(1, Math.max(0, (frame - this.frames[k]) / (this.frames[next] - this.frames[k]))) : 0;
    const p = this.poses, a = 7 * k, b = 7 * next;
    this.offset.set(p[a], p[a + 1], p[a + 2]).lerp(new THREE.Vector3(p[b], p[b + 1], p[b + 2]), share);
    this.turn.set(p[a + 3], p[a + 4], p[a + 5], p[a + 6]).slerp(new THREE.Quaternion(p[b + 3], p[b + 4], p[b + 5], p[b + 6]), share);
    const shift = this.centre.clone().add(this.offset).sub(this.centre.clone().applyQuaternion(this.turn));
    this.matrix.compose(shift, this.turn, new THREE.Vector3(1, 1, 1));
  }
}

export const BENDS = 8;

/** How one part stands and is bent, or was when it let go: steps from frame to frame, straight between two that follow each other. */
export class Shape {
  constructor({ frames, motions, weights }) {
    this.frames = integers(frames);
    this.motions = floats(motions);
    this.weights = weights ? floats(weights) : null;
    this.bend = new Array(BENDS).fill(0);
    this.matrix = new THREE.Matrix4();
  }
  /** Sets bend, and the matrix that moves points of the undeformed building; smooth: it is in one place until the next frame. */
  place(frame, smooth) {
    const k = Math.max(0, lastNotAbove(this.frames, frame)), whole = Math.floor(frame);
    const next = smooth && k + 1 < this.frames.length && this.frames[k + 1] === whole + 1 ? k + 1 : k, share = next > k ? frame - whole : 0;
    const m = this.motions, a = 7 * k, b = 7 * next;
    const shift = new THREE.Vector3(m[a], m[a + 1], m[a + 2]).lerp(new THREE.Vector3(m[b], m[b + 1], m[b + 2]), share);
    const turn = new THREE.Quaternion(m[a + 3], m[a + 4], m[a + 5], m[a + 6]).slerp(new THREE.Quaternion(m[b + 3], m[b + 4], m[b + 5], m[b + 6]), share);
    this.matrix.compose(shift, turn, new THREE.Vector3(1, 1, 1));
    if (!this.weights) return;
    for (let w = 0; w < BENDS; ++w) this.bend[w] = (1 - share) * this.weights[BENDS * k + w] + share * this.weights[BENDS * next + w];
  }
}

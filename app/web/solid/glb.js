// Read a GLB file as cad/gltf.py writes it: every body with the triangles of all its instances, in millimetres.
const JSON_CHUNK = 0x4e4f534a;

export function readGlb(buffer) {
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== 0x46546c67) throw new Error("this is not a GLB file");
  const length = view.getUint32(12, true);
  if (view.getUint32(16, true) !== JSON_CHUNK) throw new Error("this GLB file does not begin with its description");
  const about = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 20, length)));
  const read = (index) => accessor(about, buffer, 28 + length, index);
  const nodes = about.nodes[0].children.map((child) => about.nodes[child]);
  return about.meshes.map(({ primitives }, index) => {
    const places = nodes.filter((node) => node.mesh === index).map((node) => node.matrix);
    const { attributes, material } = primitives[0]; // all primitives of a body share its corners
    const colour = about.materials[material].pbrMetallicRoughness.baseColorFactor;
    const corners = primitives.flatMap(({ indices }) => Array.from(read(indices)));
    const points = read(attributes.POSITION), mesh = placed(points, read(attributes.NORMAL), corners, places);
    const painted = attributes.COLOR_0 === undefined ? undefined : cornerColours(read(attributes.COLOR_0));
    return { ...mesh, colour: screenColour(colour), painted, marks: marksOf(primitives, read, points.length / 3) };
  });
}

// Return the parameters that each corner of a body carries, as the extras of its primitives name them.
function marksOf(primitives, read, count) {
  const marks = Array.from({ length: count }, () => []);
  for (const { extras, indices } of primitives)
    for (const corner of extras ? read(indices) : []) marks[corner] = extras.parameters;
  return marks;
}

function accessor(about, buffer, start, index) {
  const { bufferView, componentType, type, count } = about.accessors[index];
  const offset = start + about.bufferViews[bufferView].byteOffset;
  const length = count * (type === "VEC3" ? 3 : 1);
  return componentType === 5126 ? new Float32Array(buffer, offset, length) : new Uint32Array(buffer, offset, length);
}

// Return the triangles of a body for each of its instances (4 × 4 matrices, column by column).
function placed(points, normals, corners, places) {
  const mesh = { x: [], y: [], z: [], i: [], j: [], k: [] }, light = [];
  for (const m of places) {
    const first = mesh.x.length;
    for (let p = 0; p < points.length; p += 3) {
      const [x, y, z] = [points[p], points[p + 1], points[p + 2]];
      mesh.x.push(m[0] * x + m[4] * y + m[8] * z + m[12]);
      mesh.y.push(m[1] * x + m[5] * y + m[9] * z + m[13]);
      mesh.z.push(m[2] * x + m[6] * y + m[10] * z + m[14]);
      light.push(brightness(m, normals[p], normals[p + 1], normals[p + 2]));
    }
    for (let c = 0; c < corners.length; c += 3) {
      mesh.i.push(first + corners[c]);
      mesh.j.push(first + corners[c + 1]);
      mesh.k.push(first + corners[c + 2]);
    }
  }
  return { mesh, light };
}

// Return the brightness of a surface: two lamps, which turn with the part, and ambient light.
const LAMPS = [{ x: -0.42, y: -0.68, z: 0.6, power: 0.62 }, { x: 0.8, y: -0.1, z: 0.59, power: 0.28 }];
const ROOM = 0.42;

function brightness(m, x, y, z) {
  const [nx, ny, nz] = [m[0] * x + m[4] * y + m[8] * z, m[1] * x + m[5] * y + m[9] * z, m[2] * x + m[6] * y + m[10] * z];
  return LAMPS.reduce((sum, lamp) => sum + lamp.power * Math.max(0, nx * lamp.x + ny * lamp.y + nz * lamp.z), ROOM);
}

const screenColour = (linear) => linear.slice(0, 3).map((part) => Math.round(255 * part ** (1 / 2.2)));

// Return the colours of the corners if a field is painted on a body, which then has one instance.
function cornerColours(linear) {
  return Array.from({ length: linear.length / 3 }, (_, corner) => screenColour(Array.from(linear.subarray(3 * corner, 3 * corner + 3))));
}

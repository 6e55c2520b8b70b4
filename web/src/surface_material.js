// SPDX-License-Identifier: GPL-3.0-or-later
// How a surface is coloured and lit. The colours keep their legend's look: a face towards the light has just its
// colour, others are darker.
import { DoubleSide, ShaderMaterial, Vector2, Vector3, Vector4 } from 'three';

/** Marks a vertex without a value; graphics cards do not agree on NaN. */
export const unknown = 1e38;

const vertex = `
attribute float scalar;
uniform vec4 drape_place;   // lower left corner, 1 / size, in the surface's own coordinates
varying float value;
varying vec2 on_drape;
varying vec3 seen, facing;
varying vec2 place;
void main() {
  value = scalar;
  place = position.xy;
  on_drape = (position.xy - drape_place.xy) * drape_place.zw;
  vec4 eye = modelViewMatrix * vec4(position, 1.0);
  seen = eye.xyz;
  facing = normalMatrix * normal;
  gl_Position = projectionMatrix * eye;
}`;

const fragment = `
uniform sampler2D table, drape;
uniform vec2 range;
uniform vec3 own_color;
uniform float own, drape_share, opacity;
uniform vec3 cut;   // unit normal and distance of the plane that cuts away; 0, 0: none
varying float value;
varying vec2 on_drape;
varying vec3 seen, facing;
varying vec2 place;
vec3 to_linear(vec3 c) { return pow(c, vec3(2.2)); }
void main() {
  if (dot(place, cut.xy) > cut.z && cut.xy != vec2(0.0)) discard;
  vec3 flat_normal = normalize(cross(dFdx(seen), dFdy(seen)));
  vec3 n = normalize(facing);
  bool behind = dot(n, flat_normal) < 0.0;   // the back of the sheet
  if (behind) n = -n;
  // Sharp edges stay sharp: where the smooth normal is far from the face's own, the face's counts.
  n = normalize(mix(flat_normal, n, smoothstep(0.86, 0.97, dot(n, flat_normal))));
  float t = range.y > range.x ? (value - range.x) / (range.y - range.x) : 0.5;
  vec3 c = value > 1e30 ? vec3(0.62) : texture2D(table, vec2((clamp(t, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  c = mix(c, own_color, own);
  if (drape_share > 0.0 && all(greaterThanEqual(on_drape, vec2(0.0))) && all(lessThanEqual(on_drape, vec2(1.0)))) {
    c = mix(c, vec3(texture2D(drape, on_drape).r), drape_share);
  }
  vec3 base = to_linear(c);
  float key = max(dot(n, normalize(vec3(-0.45, 0.55, 0.72))), 0.0);
  float fill = max(dot(n, normalize(vec3(0.6, -0.2, 0.6))), 0.0);
  float sky = 0.5 + 0.5 * n.y;
  float shine = pow(max(dot(n, normalize(vec3(-0.23, 0.28, 0.93))), 0.0), 48.0);
  float relief = 1.0 - 0.55 * drape_share;   // a picture has its own light
  vec3 lit = base * mix(1.0, 0.26 + 0.78 * key + 0.14 * fill + 0.08 * sky, relief) + 0.05 * relief * shine;
  if (behind) lit *= 0.55;
  gl_FragColor = vec4(pow(clamp(lit, 0.0, 1.0), vec3(1.0 / 2.2)), opacity);
}`;

export function make_surface_material(table) {
  return new ShaderMaterial({
    vertexShader: vertex, fragmentShader: fragment, side: DoubleSide,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    uniforms: {
      table: { value: table }, drape: { value: null }, range: { value: new Vector2() },
      own_color: { value: new Vector3() }, own: { value: 0 }, drape_share: { value: 0 }, opacity: { value: 1 },
      drape_place: { value: new Vector4(0, 0, 1, 1) }, cut: { value: new Vector3() },
    },
  });
}

/** Shader text of the part. Colours are screen colours throughout. */
import { kShade } from '../shaders';

/** Corners of a face stand one behind the other: from their number the edges are found. */
export const kPartVertex = /* glsl */ `
attribute vec3 tint;
attribute float region;
attribute float sharp;
uniform float lift; // mm towards the viewer
varying vec3 vNormal;
varying vec3 vTint;
varying vec3 vPlace;
varying vec3 vCorner;
varying float vRegion;
varying float vSharp;
void main() {
    vNormal = normalMatrix * normal;
    vTint = tint;
    vPlace = position;
    vRegion = region;
    vSharp = sharp;
    int corner = gl_VertexID % 3;
    vCorner = vec3(corner == 0 ? 1.0 : 0.0, corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0);
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * place;
    vec4 lifted = projectionMatrix * vec4(place.xy, place.z + lift, 1.0);
    gl_Position.z = lifted.z / lifted.w * gl_Position.w;
}`;

/** In front of the plane through the spindle nothing is drawn when the part is cut open. */
const kCut = /* glsl */ `
uniform float cut;
varying vec3 vPlace;
void cutOpen() {
    if (cut > 0.5 && vPlace.y > 0.0) discard;
}`;

export const kPartFragment = /* glsl */ `
uniform vec3 sky;
uniform vec3 line;
uniform vec3 sharpColour;
uniform float triangles;
uniform float frontOnly;
uniform float chosen; // id of a region, -1: all
varying vec3 vNormal;
varying vec3 vTint;
varying vec3 vCorner;
varying float vRegion;
varying float vSharp;
${kCut}
${kShade}
void main() {
    cutOpen();
    if (frontOnly > 0.5 && !gl_FrontFacing) discard;
    vec3 base = vTint;
    if (vSharp > 0.5) {
        float stripe = step(4.0, mod(gl_FragCoord.x + gl_FragCoord.y, 8.0));
        base = mix(base, sharpColour, stripe);
    }
    if (!gl_FrontFacing) base = mix(base, vec3(0.5), 0.5);
    if (chosen > -0.5 && abs(vRegion - chosen) > 0.5) base = mix(base, sky, 0.8);
    vec3 lit = base * shade(vNormal, 0.55);
    if (triangles > 0.5) {
        vec3 width = fwidth(vCorner);
        vec3 near = smoothstep(vec3(0.0), 1.2 * width, vCorner);
        float edge = 1.0 - min(min(near.x, near.y), near.z);
        float wide = clamp(1.3 - 3.0 * max(max(width.x, width.y), width.z), 0.25, 1.0);
        lit = mix(lit, line, 0.55 * edge * wide);
    }
    gl_FragColor = vec4(lit, 1.0);
}`;

export const kLineVertex = /* glsl */ `
varying vec3 vPlace;
void main() {
    vPlace = position;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

export const kLineFragment = /* glsl */ `
uniform vec3 line;
${kCut}
void main() {
    cutOpen();
    gl_FragColor = vec4(line, 1.0);
}`;

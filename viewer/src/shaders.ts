/** Shader text shared by mandrel, bands and machine. Colours are screen colours throughout; a section cuts all of it. */

/** A lamp beside the camera: shade of a view-space normal, both sides lit. */
export const kShade = /* glsl */ `
float shade(vec3 normal, float ambient) {
    vec3 n = normalize(normal);
    if (!gl_FrontFacing) n = -n;
    float lamp = max(dot(n, normalize(vec3(-0.25, 0.55, 0.8))), 0.0);
    float side = max(dot(n, normalize(vec3(0.8, -0.2, 0.3))), 0.0);
    return ambient + (1.0 - ambient) * min(lamp + 0.25 * side, 1.0);
}`;

export const kBodyVertex = /* glsl */ `
varying vec3 vNormal;
#include <clipping_planes_pars_vertex>
void main() {
    vNormal = normalMatrix * normal;
    vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * mvPosition;
    #include <clipping_planes_vertex>
}`;

export const kBodyFragment = /* glsl */ `
uniform vec3 colour;
uniform float ambient;
varying vec3 vNormal;
#include <clipping_planes_pars_fragment>
${kShade}
void main() {
    #include <clipping_planes_fragment>
    gl_FragColor = vec4(colour * shade(vNormal, ambient), 1.0);
}`;

/** Mandrel: grey, or coloured by a value per face; bare faces are hatched on the screen. */
export const kMandrelVertex = /* glsl */ `
attribute float value;
attribute float state; // 0 wall, 1 bare wall, 2 not to be wound
varying vec3 vNormal;
varying float vValue;
varying float vState;
#include <clipping_planes_pars_vertex>
void main() {
    vNormal = normalMatrix * normal;
    vValue = value;
    vState = state;
    vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * mvPosition;
    #include <clipping_planes_vertex>
}`;

export const kMandrelFragment = /* glsl */ `
uniform vec3 colour;
uniform vec3 otherColour;
uniform vec3 bareColour;
uniform float useValue;
uniform float showBare;
uniform vec2 range;
uniform sampler2D map;
varying vec3 vNormal;
varying float vValue;
varying float vState;
#include <clipping_planes_pars_fragment>
${kShade}
void main() {
    #include <clipping_planes_fragment>
    vec3 base = vState > 1.5 ? otherColour : colour;
    float ambient = 0.5;
    if (useValue > 0.5 && vState < 1.5) {
        float t = clamp((vValue - range.x) / (range.y - range.x), 0.0, 1.0);
        base = texture2D(map, vec2(t, 0.5)).rgb;
        ambient = 0.78;
    }
    if (showBare > 0.5 && vState > 0.5 && vState < 1.5) {
        float stripe = step(3.5, mod(gl_FragCoord.x + gl_FragCoord.y, 7.0));
        base = mix(bareColour, mix(bareColour, vec3(1.0), 0.75), stripe);
        ambient = 0.85;
    }
    gl_FragColor = vec4(base * shade(vNormal, ambient), 1.0);
}`;

/**
 * Bands are painted in winding order over a mandrel that is already in the depth buffer, so that
 * of two that cross the later one is on top however flat they lie. They are drawn somewhat towards
 * the viewer, since a flat band dips into a hollow surface; what faces away is left out.
 */
export const kBandVertex = /* glsl */ `
attribute float value;
attribute float across; // -1 and 1 at the band's edges
uniform float lift; // mm towards the viewer
varying vec3 vNormal;
varying vec3 vView;
varying float vValue;
varying float vAcross;
#include <clipping_planes_pars_vertex>
void main() {
    vNormal = normalMatrix * normal;
    vValue = value;
    vAcross = across;
    vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
    vView = -mvPosition.xyz;
    gl_Position = projectionMatrix * mvPosition;
    vec4 lifted = projectionMatrix * vec4(mvPosition.xy, mvPosition.z + lift, 1.0);
    gl_Position.z = lifted.z / lifted.w * gl_Position.w;
    #include <clipping_planes_vertex>
}`;

export const kBandFragment = /* glsl */ `
uniform sampler2D map;
uniform vec2 range;
uniform float categories; // how many colours repeat; 0: a sequential map
uniform vec3 noneColour;
uniform vec3 overColour;
uniform float hasLimit;
varying vec3 vNormal;
varying vec3 vView;
varying float vValue;
varying float vAcross;
#include <clipping_planes_pars_fragment>
void main() {
    #include <clipping_planes_fragment>
    vec3 n = normalize(vNormal);
    if (dot(n, vView) < 0.0) discard;
    vec3 base;
    if (vValue < -0.5) base = noneColour;
    else if (categories > 0.5) {
        base = texture2D(map, vec2((mod(floor(vValue + 0.5), categories) + 0.5) / categories, 0.5)).rgb;
    } else {
        base = texture2D(map, vec2(clamp((vValue - range.x) / (range.y - range.x), 0.0, 1.0), 0.5)).rgb;
    }
    if (hasLimit > 0.5 && vValue > range.y * 1.0001) base = overColour;
    float lamp = max(dot(n, normalize(vec3(-0.25, 0.55, 0.8))), 0.0);
    float edge = abs(vAcross);
    float width = fwidth(vAcross);
    float line = smoothstep(1.0 - max(0.12, min(1.2 * width, 0.5)), 1.0, edge);
    line *= clamp(1.2 - width, 0.0, 1.0);
    float lit = 0.72 + 0.28 * lamp;
    gl_FragColor = vec4(base * lit * (1.0 - 0.42 * line), 1.0);
}`;

/** Colour maps and what each colouring shows. */
import { DataTexture, LinearFilter, NearestFilter, NoColorSpace, RGBAFormat } from 'three';

/**
 * Anchors of the sequential map, dark blue over teal to yellow: even steps in lightness, told
 * apart without red and green (after the published "viridis" table, every sixteenth of it).
 */
const kSequential = [
    0x440154, 0x481a6c, 0x472f7d, 0x414487, 0x39568c, 0x31688e, 0x2a788e, 0x23888e, 0x1f988b, 0x22a884,
    0x35b779, 0x54c568, 0x7ad151, 0xa5db36, 0xd2e21b, 0xfde725,
];

/** Eight colours that stay apart for the colour-blind (Okabe and Ito), black left out. */
const kCategories = [0x0072b2, 0xe69f00, 0x009e73, 0xcc79a7, 0x56b4e9, 0xd55e00, 0xf0e442, 0x7a6fb0];

export const kBare = '#d55e00';
export const kOverLimit = '#e0007a';

const kTexels = 256;

function rgb(hex: number): [number, number, number] {
    return [(hex >> 16) & 255, (hex >> 8) & 255, hex & 255];
}

/** Colour of a place 0..1 of the sequential map, sRGB 0..255. */
export function sequential(t: number): [number, number, number] {
    const x = Math.min(Math.max(t, 0), 1) * (kSequential.length - 1);
    const i = Math.min(Math.floor(x), kSequential.length - 2);
    const [a, b] = [rgb(kSequential[i]), rgb(kSequential[i + 1])];
    return [0, 1, 2].map((k) => Math.round(a[k] + (x - i) * (b[k] - a[k]))) as [number, number, number];
}

export function category(n: number): [number, number, number] {
    return rgb(kCategories[n % kCategories.length]);
}

function texture(colours: [number, number, number][], smooth: boolean): DataTexture {
    const data = new Uint8Array(colours.flatMap((c) => [...c, 255]));
    const result = new DataTexture(data, colours.length, 1, RGBAFormat);
    result.colorSpace = NoColorSpace; // shaders write screen colours, so that the legend is met
    result.magFilter = smooth ? LinearFilter : NearestFilter;
    result.minFilter = result.magFilter;
    result.needsUpdate = true;
    return result;
}

export const sequentialTexture = texture(
    Array.from({ length: kTexels }, (_, i) => sequential(i / (kTexels - 1))),
    true,
);
export const categoryTexture = texture(
    kCategories.map((c) => rgb(c)),
    false,
);

export type ColouringId = 'course' | 'family' | 'slip' | 'bridging' | 'layers' | 'thickness' | 'angle' | 'wall';

export interface Colouring {
    id: ColouringId;
    label: string;
    unit: string;
    kind: 'sequential' | 'categories';
    min: number;
    max: number;
    limit: number | null;
    note: string;
    perFace: Float32Array | null; // null: bands are coloured
}

/** CSS gradient of the sequential map. */
export function gradient(): string {
    const stops = kSequential.map((c) => `#${c.toString(16).padStart(6, '0')}`);
    return `linear-gradient(to right, ${stops.join(', ')})`;
}

export function cssColour([r, g, b]: [number, number, number]): string {
    return `rgb(${r}, ${g}, ${b})`;
}

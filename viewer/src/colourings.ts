/** The colourings of a page, with their ranges and limits. */
import type { Page } from './data';
import type { Colouring } from './colour';
import type { Check } from './types';

function largest(arrays: Float32Array[]): number {
    let worst = 0;
    for (const array of arrays) for (let i = 0; i < array.length; ++i) worst = Math.max(worst, array[i]);
    return worst;
}

/** The next round number that is not below. */
function roundUp(value: number): number {
    if (!(value > 0)) return 1;
    const step = 10 ** Math.floor(Math.log10(value));
    for (const f of [1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10]) if (f * step >= value * 0.9999) return f * step;
    return 10 * step;
}

function limitOf(checks: Record<string, Check> | undefined, name: string, key: string): number | null {
    const value = (checks?.[name] as Record<string, unknown> | undefined)?.[key];
    return typeof value === 'number' ? value : null;
}

/** \param layer index of the layer shown, or null for all together */
export function colouringsOf(page: Page, layer: number | null): Colouring[] {
    const checks = page.header.report.checks;
    const layers = layer === null ? page.layers : [page.layers[layer]];
    const fibres = layers.flatMap((l) => l.fibres);
    const values = layer === null ? page.total : page.layers[layer].values;
    const lastCourse = Math.max(0, ...fibres.flatMap((f) => f.header.pieces.map((p) => p.course)));
    const slipLimit = limitOf(checks, 'slip', 'limit') ?? page.header.tow.friction;
    const bridgeLimit = limitOf(checks, 'bridging', 'limit_mm');
    const worstBridge = largest(fibres.map((f) => f.bridge));
    const band = { kind: 'sequential' as const, limit: null, note: '', perFace: null };
    const colourings: Colouring[] = [
        {
            ...band,
            id: 'course',
            label: 'Course',
            unit: '',
            min: 0,
            max: Math.max(lastCourse, 1),
            note: 'in winding order; what leads from course to course is grey',
        },
        {
            ...band,
            id: 'family',
            label: 'Family',
            unit: '',
            kind: 'categories',
            min: 0,
            max: Math.max(0, ...fibres.flatMap((f) => f.header.pieces.map((p) => p.family))),
            note: 'parallel courses; grey belongs to none',
        },
        {
            ...band,
            id: 'slip',
            label: 'Slip',
            unit: '',
            min: 0,
            max: slipLimit,
            limit: slipLimit,
            note: 'sideways pull over normal pull; the limit is the friction',
        },
        {
            ...band,
            id: 'bridging',
            label: 'Bridging',
            unit: 'mm',
            min: 0,
            max: bridgeLimit ?? roundUp(worstBridge),
            limit: bridgeLimit,
            note: 'gap under the fibre',
        },
        {
            ...band,
            id: 'layers',
            label: 'Layers',
            unit: '',
            min: 0,
            max: roundUp(largest([values.layers])),
            perFace: values.layers,
            note: 'bands over each place of the finished part',
        },
        {
            ...band,
            id: 'thickness',
            label: 'Thickness',
            unit: 'mm',
            min: 0,
            max: roundUp(largest([values.thickness])),
            perFace: values.thickness,
            note: 'of the finished part',
        },
        {
            ...band,
            id: 'angle',
            label: 'Winding angle',
            unit: '°',
            min: 0,
            max: 90,
            note: "fibre to the region's own axis; 90° is a hoop",
        },
    ];
    if (page.wall) {
        colourings.push({
            ...band,
            id: 'wall',
            label: 'Wall',
            unit: '×',
            min: 0,
            max: 2,
            perFace: page.wall.ratio,
            note: 'layers of the finished wall over those asked for; below 1 it is too thin',
        });
    }
    return colourings;
}

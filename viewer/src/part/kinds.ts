/** What the surface of a part is taken for, and the colours of it (Okabe and Ito). */
import { category, cssColour } from '../colour';
import type { Region } from './data';

export interface Kind {
    id: 'wound' | 'left' | 'end-cap' | 'bore' | 'other' | 'details';
    words: string;
    rgb: [number, number, number];
}

export const kKinds: Kind[] = [
    { id: 'wound', words: 'wound', rgb: [0x56, 0xb4, 0xe9] },
    { id: 'left', words: 'outside, not wound', rgb: [0x9a, 0xa3, 0xad] },
    { id: 'end-cap', words: 'end face', rgb: [0xe6, 0x9f, 0x00] },
    { id: 'bore', words: 'bore or inner skin', rgb: [0x00, 0x9e, 0x73] },
    { id: 'other', words: 'neither', rgb: [0xcc, 0x79, 0xa7] },
    { id: 'details', words: 'taken off: lettering and the like', rgb: [0xd5, 0x5e, 0x00] },
];

export const kSharp = '#f0e442';
export const kDetails = kKinds[5];

export function kindOf(region: Region): Kind {
    if (region.kept) return kKinds[0];
    if (region.kind === 'outer-wall') return kKinds[1];
    return kKinds.find((k) => k.id === region.kind) ?? kKinds[4];
}

export type Colours = 'kind' | 'region';

export function colourOf(region: Region, by: Colours): [number, number, number] {
    return by === 'kind' ? kindOf(region).rgb : category(region.id);
}

export function cssOf(region: Region, by: Colours): string {
    return cssColour(colourOf(region, by));
}

/** Keys of the page and the list of them in the help. */

export interface KeyActions {
    playOrPause: () => void;
    stepBlock: (by: 1 | -1) => void;
    stepCourse: (by: 1 | -1) => void;
    toStart: () => void;
    toEnd: () => void;
    colouring: (number: number) => void;
    rangeFrom: () => void;
    rangeTo: () => void;
    allCourses: () => void;
    foldSide: () => void;
    foldPlots: () => void;
    section: () => void;
    measure: () => void;
    camera: () => void;
    fit: () => void;
    help: () => void;
}

const kKeys: [string, string][] = [
    ['Space', 'play or pause'],
    ['\u2190 \u2192', 'a block back or on'],
    ['\u2191 \u2193', 'a course back or on'],
    ['Home End', 'to the start or the end'],
    ['1 \u2026 7', 'course, family, slip, bridging, layers, thickness, angle'],
    ['B E', 'the course under way is the first, the last one drawn'],
    ['A', 'draw all courses'],
    ['M', 'camera with the machine or on the mandrel'],
    ['X', 'section square to x, y, z, none'],
    ['D', 'measure a distance: click two places'],
    ['F', 'see part and head, wherever they go'],
    ['S P', 'fold or show the findings, the axes and plots'],
    ['?', 'this list'],
];

export function helpHtml(): string {
    return kKeys
        .map(([keys, words]) => {
            const caps = keys.split(' ').map((k) => `<kbd>${k}</kbd>`);
            return `<dt>${caps.join(' ')}</dt><dd>${words}</dd>`;
        })
        .join('');
}

export function listenToKeys(actions: KeyActions): void {
    window.addEventListener(
        'keydown',
        (event) => {
            if (event.ctrlKey || event.metaKey || event.altKey) return;
            if (document.querySelector('dialog[open]')) return;
            const target = event.target as HTMLElement;
            if (target.matches('select, input[type=text]')) return;
            const scrolls = target.closest('.listing, .panel') !== null;
            const action = actionOf(event, actions, scrolls, target);
            if (!action) return;
            event.preventDefault();
            event.stopPropagation();
            action();
        },
        { capture: true },
    );
}

function actionOf(
    event: KeyboardEvent,
    actions: KeyActions,
    scrolls: boolean,
    target: HTMLElement,
): (() => void) | null {
    const { key, shiftKey } = event;
    if (/^[1-8]$/.test(key)) return () => actions.colouring(Number(key));
    if (target.getAttribute('role') === 'tab' && key.startsWith('Arrow')) return null;
    if (target.closest('.range, .border, #section-at') && /^(Arrow|Home|End)/.test(key)) return null;
    switch (key) {
        case ' ':
            // Buttons and boxes keep their own meaning of the space bar.
            return target.matches('button, input[type=checkbox]') ? null : actions.playOrPause;
        case 'ArrowLeft':
            return () => (shiftKey ? actions.stepCourse(-1) : actions.stepBlock(-1));
        case 'ArrowRight':
            return () => (shiftKey ? actions.stepCourse(1) : actions.stepBlock(1));
        case 'ArrowUp':
            return scrolls ? null : () => actions.stepCourse(-1);
        case 'ArrowDown':
            return scrolls ? null : () => actions.stepCourse(1);
        case 'Home':
            return scrolls ? null : actions.toStart;
        case 'End':
            return scrolls ? null : actions.toEnd;
        default:
            return actionOfLetter(key.toLowerCase(), actions);
    }
}

function actionOfLetter(letter: string, actions: KeyActions): (() => void) | null {
    switch (letter) {
        case 'b':
            return actions.rangeFrom;
        case 'e':
            return actions.rangeTo;
        case 'a':
            return actions.allCourses;
        case 's':
            return actions.foldSide;
        case 'p':
            return actions.foldPlots;
        case 'x':
            return actions.section;
        case 'd':
            return actions.measure;
        case 'm':
            return actions.camera;
        case 'f':
            return actions.fit;
        case '?':
            return actions.help;
        default:
            return null;
    }
}

/** Which courses are drawn: of those shown, from one to another in winding order, with what joins them. */
import type { CourseRow } from './courses';
import type { Program } from './timeline';

export class CourseRange {
    /** Courses of what is shown; transitions between them go with them. */
    courses: CourseRow[] = [];
    first = 0; // into courses
    last = 0;

    constructor(private readonly rows: CourseRow[]) {
        this.show(null);
    }

    /** All courses of a layer (index), or of all layers. */
    show(layer: number | null): void {
        this.courses = this.rows.filter(
            (r) => r.piece.kind === 'course' && (layer === null || r.program.fibre.layer === layer),
        );
        this.set(0, Infinity);
    }

    set(first: number, last: number): void {
        const end = Math.max(this.courses.length - 1, 0);
        this.first = Math.min(Math.max(first, 0), end);
        this.last = Math.min(Math.max(last, this.first), end);
    }

    isWhole(): boolean {
        return this.first === 0 && this.last >= this.courses.length - 1;
    }

    /** The course under way at a time of the common clock: the last one that has begun. */
    at(time: number): number {
        const next = this.courses.findIndex((r) => r.start > time + 1e-6);
        return Math.max((next < 0 ? this.courses.length : next) - 1, 0);
    }

    /** First and last station drawn of a program; none where the last is not after the first. */
    stationsOf(program: Program): { from: number; to: number } {
        let [from, to] = [0, Infinity];
        if (this.first > 0) {
            const row = this.courses[this.first];
            if (program.index < row.program.index) from = Infinity;
            if (program === row.program) from = row.piece.first;
        }
        if (this.last < this.courses.length - 1) {
            const row = this.courses[this.last];
            if (program.index > row.program.index) to = 0;
            if (program === row.program) to = row.piece.first + row.piece.count - 1;
        }
        return { from, to };
    }
}

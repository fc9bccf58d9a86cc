// How far an interpolated surface may be from where its normals say, in voxels: with less, rays that leave hollow surfaces meet them.
const BLUR: f32 = 0.1;

// A place among the samples.
struct Cell {
    // The number in the table of the brick it is in, and what that holds: the value in the brick's middle, and the number of its fine
    // samples or -1.
    number: i32,
    brick: vec2<f32>,
    // The place in cells from the brick's least corner.
    local: vec3<f32>,
}

// The least corner of the box of samples.
fn voxels_min() -> vec3<f32> {
    return triple(VOXELS);
}

// The greatest corner.
fn voxels_max() -> vec3<f32> {
    return triple(VOXELS) + f32(CELLS) * parameters[VOXELS + 3] * triple(VOXELS + 4);
}

// The number of a brick in the table.
fn number_of(brick: vec3<f32>) -> i32 {
    return i32(brick.x + parameters[VOXELS + 4] * (brick.y + parameters[VOXELS + 5] * brick.z));
}

// The cell of a point in the box, or the nearest one.
fn cell_at(p: vec3<f32>) -> Cell {
    let cells: vec3<f32> = (p - voxels_min()) / parameters[VOXELS + 3];
    let brick: vec3<f32> = min(max(floor(cells / f32(CELLS)), vec3<f32>(0.0)), triple(VOXELS + 4) - vec3<f32>(1.0));
    let number: i32 = number_of(brick);
    let local: vec3<f32> = min(max(cells - f32(CELLS) * brick, vec3<f32>(0.0)), vec3<f32>(f32(CELLS)));
    return Cell(number, voxel(number), local);
}

// The place in the table of a fine sample.
fn fine_place(cell: Cell, sample_at: vec3<f32>) -> i32 {
    let within: f32 = sample_at.x + f32(SAMPLES) * (sample_at.y + f32(SAMPLES) * sample_at.z);
    return i32(parameters[VOXELS + 7]) + SAMPLES * SAMPLES * SAMPLES * i32(cell.brick.y) + i32(within);
}

// The least corner of the fine samples around a cell's place.
fn first_of(cell: Cell) -> vec3<f32> {
    return min(floor(cell.local), vec3<f32>(f32(CELLS) - 1.0));
}

// Trilinear interpolation of values between eight entries of the table, with the ways from one to the next along each axis.
fn between(place: i32, x: i32, y: i32, z: i32, share: vec3<f32>) -> f32 {
    let low: vec4<f32> = vec4<f32>(voxel(place).x, voxel(place + y).x, voxel(place + z).x, voxel(place + y + z).x);
    let next: i32 = place + x;
    let high: vec4<f32> = vec4<f32>(voxel(next).x, voxel(next + y).x, voxel(next + z).x, voxel(next + y + z).x);
    let lines: vec4<f32> = low + share.x * (high - low);
    let faces: vec2<f32> = lines.xz + share.y * (lines.yw - lines.xz);
    return faces.x + share.z * (faces.y - faces.x);
}

// The value at a place with fine samples.
fn fine_value(cell: Cell) -> f32 {
    let first: vec3<f32> = first_of(cell);
    return between(fine_place(cell, first), 1, SAMPLES, SAMPLES * SAMPLES, cell.local - first);
}

// The value at a place without, by the middles of bricks around it.
fn coarse_value(p: vec3<f32>, own: f32) -> f32 {
    let size: f32 = f32(CELLS) * parameters[VOXELS + 3];
    let counts: vec3<f32> = triple(VOXELS + 4);
    let last: vec3<f32> = counts - vec3<f32>(1.0);
    let local: vec3<f32> = min(max((p - voxels_min()) / size - vec3<f32>(0.5), vec3<f32>(0.0)), last);
    let first: vec3<f32> = min(floor(local), max(last - vec3<f32>(1.0), vec3<f32>(0.0)));
    // Along an axis with a single brick there is no next one.
    let x: i32 = select(0, 1, counts.x > 1.0);
    let y: i32 = select(0, i32(counts.x), counts.y > 1.0);
    let z: i32 = select(0, i32(counts.x * counts.y), counts.z > 1.0);
    let value: f32 = between(number_of(first), x, y, z, local - first);
    // Middles at the border lie to one side of what is around: no value differs by more than the distance.
    let reach: f32 = 0.5 * length(vec3<f32>(size));
    return min(max(value, own - reach), own + reach);
}

// What is known of a point outside of the box from the value at the nearest point of it: the way there and that value are at an
// obtuse angle.
fn seen_from(p: vec3<f32>, inside: vec3<f32>, value: f32) -> f32 {
    let away: f32 = length(p - inside);
    return select(length(vec2<f32>(away, max(value, 0.0))), value, away == 0.0);
}

// The nearest point of the box.
fn into_box(p: vec3<f32>) -> vec3<f32> {
    return min(max(p, voxels_min()), voxels_max());
}

// The sampled field at a point.
fn sampled(p: vec3<f32>) -> f32 {
    let inside: vec3<f32> = into_box(p);
    let cell: Cell = cell_at(inside);
    var value: f32 = 0.0;
    if (cell.brick.y >= 0.0) {
        value = fine_value(cell);
    } else {
        value = coarse_value(inside, cell.brick.x);
    }
    return seen_from(p, inside, value) / parameters[SCALE];
}

// How far a ray may go from a point before it meets what was sampled; its number is 0 where fine samples are and inside, where a
// surface may be near.
fn reach_at(p: vec3<f32>, parts: i32) -> vec2<f32> {
    let inside: vec3<f32> = into_box(p);
    let cell: Cell = cell_at(inside);
    let scale: f32 = parameters[SCALE];
    if (cell.brick.y >= 0.0) {
        return vec2<f32>(seen_from(p, inside, fine_value(cell)) / scale, 0.0);
    }
    // No value differs by more than the distance, and what holds no fine samples is no nearer than the margin.
    let voxel_size: f32 = parameters[VOXELS + 3];
    let away: f32 = length(cell.local - vec3<f32>(0.5 * f32(CELLS))) * voxel_size;
    let least: f32 = max(abs(cell.brick.x) - away, f32(MARGIN) * voxel_size);
    let free: f32 = select(least, -least, cell.brick.x < 0.0);
    return vec2<f32>(seen_from(p, inside, free) / scale, select(-1.0, 0.0, free < 0.0));
}

// How far a ray may go from a point in a direction.
fn free_at(p: vec3<f32>, direction: vec3<f32>, parts: i32) -> f32 {
    return reach_at(p, parts).x * parameters[SCALE];
}

// How far the nearest surface seems to be: `reach_at` says only how far it is at least.
fn seen_clearance(near: vec2<f32>, p: vec3<f32>) -> f32 {
    if (near.y < 0.0) {
        return max(near.x, sampled(p)) * parameters[SCALE];
    }
    return near.x * parameters[SCALE];
}

// How far surfaces may be from where they seem to be.
fn blur() -> f32 {
    return BLUR * parameters[VOXELS + 3];
}

// The sampled field at a point where it is less than `most`.
fn unscaled(p: vec3<f32>, most: f32) -> vec2<f32> {
    return closer(vec2<f32>(most, -1.0), sampled(p), 0.0);
}

// The gradient by central differences over a voxel to each side, which do not jump from cell to cell, and the value.
fn part_gradient(part: i32, p: vec3<f32>) -> vec4<f32> {
    let h: f32 = parameters[VOXELS + 3];
    let x: f32 = sampled(p + vec3<f32>(h, 0.0, 0.0)) - sampled(p - vec3<f32>(h, 0.0, 0.0));
    let y: f32 = sampled(p + vec3<f32>(0.0, h, 0.0)) - sampled(p - vec3<f32>(0.0, h, 0.0));
    let z: f32 = sampled(p + vec3<f32>(0.0, 0.0, h)) - sampled(p - vec3<f32>(0.0, 0.0, h));
    return vec4<f32>(vec3<f32>(x, y, z) / (2.0 * h), sampled(p));
}

// What the samples or a plane look like at a point of their surface: the eight samples around it each have a share.
fn surface_at(part: i32, spot: Spot) -> Surface {
    let cell: Cell = cell_at(spot.position);
    if (part >= PART_COUNT || cell.brick.y < 0.0) {
        return with_share(no_surface(), 1.0, REGIONS + REGION_SIZE * part, spot);
    }
    let first: vec3<f32> = first_of(cell);
    let share: vec3<f32> = cell.local - first;
    var surface: Surface = no_surface();
    for (var z: i32 = 0; z < 2; z++) {
        for (var y: i32 = 0; y < 2; y++) {
            for (var x: i32 = 0; x < 2; x++) {
                let step_to: vec3<f32> = vec3<f32>(f32(x), f32(y), f32(z));
                let weights: vec3<f32> = vec3<f32>(1.0) - abs(step_to - share);
                let region: i32 = i32(voxel(fine_place(cell, first + step_to)).y);
                surface = with_share(surface, weights.x * weights.y * weights.z, REGIONS + REGION_SIZE * region, spot);
            }
        }
    }
    return settled(surface);
}

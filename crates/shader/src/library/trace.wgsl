// A hit is a false one if by its gradient the surface is still this many tolerances away.
const FALSE_HIT: f32 = 2.0;

// The least gradient a surface is expected to have.
const FLATTEST: f32 = 0.001;

// A ray that ran out of steps shows the surface it is creeping along if that is nearer than this many tolerances.
const CREEPING: f32 = 64.0;

// How much farther than the free distance a step goes at first; it is taken back where it might have passed a surface.
const RELAXATION: f32 = 1.2;

// How often a march goes on after a false hit.
const MOST_MARCHES: i32 = 16;

// The share of the tolerance that is used at formulas, whose zeros the processor finds exactly.
const FORMULA_SHARE: f32 = 0.0625;

// The share of the tolerance that is used at a part.
fn share_at(part: f32) -> f32 {
    if (FORMULA_COUNT == 0 || part < 0.0) {
        return 1.0;
    }
    return select(1.0, FORMULA_SHARE, parameters[PARTS + PART_SIZE * i32(part) + 10] == 2.0);
}

// What a ray met.
struct Hit {
    // The distance from the ray's origin; FAR if it met nothing.
    distance: f32,
    part: i32,
    steps: i32,
    is_unresolved: bool,
    position: vec3<f32>,
    normal: vec3<f32>,
    viewer: vec3<f32>,
    // How far the position may be from the surface, and what errors of position are tolerated there.
    uncertainty: f32,
    tolerance: f32,
    // How fast the marched field grows away from the surface.
    slope: f32,
}

// Where a ray meets a plane that objects end at: a half-space, or a sheet; FAR if it does not.
fn plane_hit(ray: Ray, first: i32) -> f32 {
    let height: f32 = dot(triple(first), ray.origin) - parameters[first + 3];
    let descent: f32 = -dot(triple(first), ray.direction);
    if (parameters[first + 4] > 0.0) {
        let t: f32 = height / away_from_zero(descent);
        return select(FAR, t, t >= 0.0 && abs(descent) > 1e-20);
    }
    if (height <= 0.0) {
        return 0.0;
    }
    return select(FAR, height / away_from_zero(descent), descent > 1e-20);
}

// The value of a plane's object, and the plane's number.
fn plane_value(p: vec3<f32>, first: i32) -> f32 {
    let height: f32 = (dot(triple(first), p) - parameters[first + 3]) * parameters[first + 5];
    return select(height, abs(height), parameters[first + 4] > 0.0);
}

// The plane nearest to a point, if it is nearer than what is so far.
fn nearest_plane(so_far: vec2<f32>, p: vec3<f32>) -> vec2<f32> {
    var d: vec2<f32> = so_far;
    for (var i: i32 = 0; i < PLANE_COUNT; i++) {
        d = closer(d, plane_value(p, PLANES + PLANE_SIZE * i), f32(PART_COUNT + i));
    }
    return d;
}

// Whether two numbered parts are seen from both sides.
fn is_sheet(part: i32) -> bool {
    return parameters[REGIONS + REGION_SIZE * part + 20] > 0.0;
}

fn facing(normal: vec3<f32>, viewer: vec3<f32>, part: i32) -> vec3<f32> {
    return select(normal, -normal, is_sheet(part) && dot(normal, viewer) < 0.0);
}

// How far a ray may go where a formula has a value (w) and a gradient (xyz): as far as the parabola stays positive that lies below
// the field, since its slope falls by no more than `fall` on a unit of length; at least as far as its steepest slope allows.
fn ahead(value: vec4<f32>, direction: vec3<f32>, fall: f32, safe: f32) -> f32 {
    let slow: f32 = value.w * safe;
    if (fall < 0.0 || value.w <= 0.0) {
        return slow;
    }
    let slope: f32 = dot(value.xyz, direction);
    let root: f32 = sqrt(slope * slope + 2.0 * fall * value.w);
    if (slope < 0.0) {
        return max(slow, 2.0 * value.w / (root - slope));
    }
    return max(slow, min((root + slope) / max(fall, 1e-20), FAR));
}

// Whether what is nearest to a point is a formula.
fn is_formula(part: f32) -> bool {
    if (FORMULA_COUNT == 0 || part < 0.0) {
        return false;
    }
    return parameters[PARTS + PART_SIZE * i32(part) + 10] > 0.0;
}

// What a march along a ray came to.
struct March {
    // Where it ended, and what it met there; -1 for nothing.
    distance: f32,
    part: i32,
    steps: i32,
    is_unresolved: bool,
    // The gradient of the part's field there, and its value.
    gradient: vec4<f32>,
}

// Marches along a ray through what `reach_at` knows as `parts`: all of them, or a single one.
fn march(ray: Ray, start: f32, end: f32, parts: i32) -> March {
    let scale: f32 = parameters[SCALE];
    var t: f32 = start;
    var steps: i32 = 0;
    var part: i32 = -1;
    var is_unresolved: bool = false;
    var gradient: vec4<f32> = vec4<f32>(0.0);
    // The field value that counts as a hit, in tolerances.
    var fineness: f32 = 1.0 / scale;
    for (var marches: i32 = 0; marches < MOST_MARCHES; marches++) {
        if (t >= end) {
            break;
        }
        var reach: f32 = 0.0;
        var near: vec2<f32> = vec2<f32>(FAR, -1.0);
        // How far the ray was free ahead of the point before, and how far the step from there went. Back from a point, only the ball
        // around it is free.
        var before: f32 = 0.0;
        var stride: f32 = 0.0;
        var is_near: bool = false;
        loop {
            let p: vec3<f32> = ray.origin + t * ray.direction;
            near = reach_at(p, parts);
            reach = tolerance_at(t, length(p)) * share_at(near.y);
            let ball: f32 = near.x * scale * parameters[STEP_FACTOR];
            if (stride > before + max(ball, 0.0) && stride > 0.0) {
                t = t - stride + before;
                stride = before;
                steps += 1;
                continue;
            }
            is_near = near.y >= 0.0 && near.x < max(reach * fineness, ROUNDING * length(p));
            if (is_near || steps >= i32(parameters[MAX_STEPS])) {
                break;
            }
            before = ball;
            if (is_formula(near.y)) {
                before = max(ball, free_at(p, ray.direction, parts) * parameters[STEP_FACTOR]);
            }
            stride = select(before, max(before, ball * RELAXATION), t + ball * RELAXATION < end);
            t += stride;
            steps += 1;
            if (t >= end) {
                break;
            }
        }
        if (t >= end && !is_near) {
            break;
        }
        is_unresolved = !is_near;
        if (near.y < 0.0) {
            break;
        }
        part = i32(near.y);
        // On the very surface many fields have no slope: then that of the way there, as near as is tolerated.
        let back: f32 = select(0.0, reach, near.x == 0.0);
        gradient = part_gradient(part, ray.origin + (t - back) * ray.direction);
        let slope: f32 = max(length(gradient.xyz) * parameters[PARTS + PART_SIZE * part + 6], FLATTEST);
        if (is_unresolved && near.x >= CREEPING * share_at(near.y) * reach * slope) {
            part = -1;
            break;
        }
        // Rounding errors of values do not shrink with the slope.
        let least: f32 = ROUNDING * (length(ray.origin) + t);
        let is_false: bool = near.x > FALSE_HIT * reach * slope && near.x > least;
        if (!is_false || is_unresolved || marches + 1 == MOST_MARCHES) {
            break;
        }
        fineness = slope;
        part = -1;
    }
    return March(t, part, steps, is_unresolved, gradient);
}

// The first surface on a ray.
fn trace(ray: Ray) -> Hit {
    var plane_at: f32 = FAR;
    var plane: i32 = -1;
    for (var i: i32 = 0; i < PLANE_COUNT; i++) {
        let t_plane: f32 = plane_hit(ray, PLANES + PLANE_SIZE * i);
        if (t_plane < plane_at) {
            plane_at = t_plane;
            plane = i;
        }
    }
    let met: March = first_met(ray, min(plane_at, parameters[MAX_DISTANCE]));
    let viewer: vec3<f32> = -ray.direction;
    if (met.part >= 0) {
        let position: vec3<f32> = ray.origin + met.distance * ray.direction;
        let steepness: f32 = length(met.gradient.xyz);
        let normal: vec3<f32> = select(viewer, met.gradient.xyz / max(steepness, 1e-30), steepness > 0.0);
        let tolerance: f32 = tolerance_at(met.distance, length(position));
        let away: f32 = max(tolerance, blur());
        let slope: f32 = clamp(steepness * parameters[PARTS + PART_SIZE * met.part + 6], FLATTEST, 1.0);
        let facing_normal: vec3<f32> = facing(normal, viewer, met.part);
        return Hit(met.distance, met.part, met.steps, met.is_unresolved, position, facing_normal, viewer, away, tolerance, slope);
    }
    if (plane >= 0) {
        let position: vec3<f32> = ray.origin + plane_at * ray.direction;
        let number: i32 = PART_COUNT + plane;
        let normal: vec3<f32> = facing(triple(PLANES + PLANE_SIZE * plane), viewer, number);
        let offset: f32 = length(position);
        let away: f32 = ROUNDING * max(offset, plane_at);
        let tolerance: f32 = tolerance_at(plane_at, offset);
        let slope: f32 = 1.0 / parameters[SCALE];
        return Hit(plane_at, number, met.steps, met.is_unresolved, position, normal, viewer, away, tolerance, slope);
    }
    return Hit(FAR, -1, met.steps, met.is_unresolved, ray.origin, vec3<f32>(0.0), viewer, 0.0, 0.0, 1.0);
}

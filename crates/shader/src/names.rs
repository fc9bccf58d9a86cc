//! Names that mean nothing else yet, in any of the languages.

use std::collections::HashSet;

/// Words that some language keeps for itself, and functions that it comes with.
const TAKEN: &str = "\
    NULL Self abs abstract acos acosh active alias alignas alignof all any array as asin asinh asm async atan atan2 atanh \
    atomic attribute auto await become bitcast bool break buffer case cast catch ceil centroid clamp class coherent \
    column_major common compile concept const const_assert const_cast consteval constexpr constinit continue continuing cos \
    cosh crate cross debugger decltype default degrees delete demote determinant dFdx dFdy diagnostic discard distance do dot \
    double dpdx dpdy dynamic_cast else enable enum equal exp exp2 explicit export extends extern external \
    faceforward fallthrough false filter final finally firstbithigh fixed flat float floor fma fn for frac fract friend from \
    fwidth get goto groupshared half highp if impl implements import in inline inout input instanceof int interface \
    invariant inverse inverseSqrt inversesqrt isinf isnan kernel layout ldexp length lerp let line linear log log2 long loop \
    lowp macro main mainImage mat2 mat3 mat4 match matrix max mediump meta metal min mix mod modf module move mul mut mutable \
    namespace new nil noexcept noinline noise normalize not null nullptr of operator out output outerProduct override package \
    parameter parameters partition pass patch point pow precise precision premerge private protected ptr pub public radians \
    readonly ref reflect refract register require resource restrict return round row_major rsqrt sample sampler saturate select self \
    set shared short sign signed sin sincos sinh sizeof smooth smoothstep snorm sqrt static std step struct \
    subroutine super switch target technique template texture this thread threadgroup throw trait transpose true trunc try type \
    typedef typename uint uniform union unless unorm unsafe unsigned unsized use using var varying vec2 vec3 vec4 vertex view \
    virtual void volatile wgsl where while with workgroup writeonly xor yield and or not_eq and_eq or_eq xor_eq";

/// Names in use.
#[derive(Clone, Debug)]
pub(crate) struct Names(HashSet<String>);

impl Names {
    /// All words that no language leaves free.
    pub(crate) fn new() -> Self {
        Self(TAKEN.split_whitespace().map(str::to_owned).collect())
    }

    /// Takes a name as it is.
    pub(crate) fn take(&mut self, name: &str) {
        self.0.insert(name.to_owned());
    }

    /// A free name that looks like the wanted one: letters, digits and single underscores, none at its ends.
    pub(crate) fn make(&mut self, wanted: &str) -> String {
        let mut name = String::new();
        for c in wanted.chars() {
            if c.is_ascii_alphanumeric() {
                name.push(c.to_ascii_lowercase());
            } else if !name.is_empty() && !name.ends_with('_') {
                name.push('_');
            }
        }
        let mut name = name.trim_matches('_').to_owned();
        // `gl` begins names of the OpenGL languages.
        if name.is_empty() || name.starts_with(|c: char| c.is_ascii_digit()) || name.starts_with("gl_") {
            name.insert_str(0, "the_");
            name = name.trim_end_matches('_').to_owned();
        }
        let mut free = name.clone();
        let mut number = 2;
        while !self.0.insert(free.clone()) {
            free = format!("{name}_{number}");
            number += 1;
        }
        free
    }
}

#[cfg(test)]
mod tests {
    use super::Names;

    #[test]
    fn names_are_words_and_differ() {
        let mut names = Names::new();
        assert_eq!(names.make("Cup & saucer"), "cup_saucer");
        assert_eq!(names.make("cup_saucer"), "cup_saucer_2");
        assert_eq!(names.make("union"), "union_2");
        assert_eq!(names.make("2 balls"), "the_2_balls");
        assert_eq!(names.make("äöü"), "the");
        assert_eq!(names.make("__x__y"), "x_y");
    }
}

// What is to be computed: the size of the picture in pixels, the upper left pixel of the tile, where in its pixel the sample
// lies, seconds since the start, and what is shown.
struct View {
    vec2 size;
    vec2 tile;
    vec2 place;
    float time;
    int show;
};

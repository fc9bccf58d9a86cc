// A scene of distance fields, made into a compute shader for Unity by Freikugel.
//
// Kernel `render` fills `picture` (RWTexture2D<float4>, enableRandomWrite) in groups of 8 x 8 pixels. `parameters` is a
// ComputeBuffer of type Raw with the table of numbers, `view` a constant buffer of 48 bytes: width, height, 0, 0, 0.5, 0.5,
// time, what to show (an int; 0 for the lit picture), 0, 0, 0, 1.
//
// Scenes are right-handed with z up, Unity is left-handed with y up: swapping y and z converts both ways. The functions
// `freikugel_distance` and `freikugel_gradient` at the end take and return Unity's coordinates.
#pragma kernel render


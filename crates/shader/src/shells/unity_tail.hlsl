
// The field at a point in Unity's coordinates, relative to the scene's origin.
float freikugel_distance(float3 p)
{
    return whole(p.xzy).x;
}

// Its gradient.
float3 freikugel_gradient(float3 p)
{
    return field_gradient(p.xzy).xzy;
}

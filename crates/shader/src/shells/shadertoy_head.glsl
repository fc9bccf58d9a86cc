// A scene of distance fields, made into a shader by Freikugel. Drag with the mouse to turn it.

// All numbers of the scene.

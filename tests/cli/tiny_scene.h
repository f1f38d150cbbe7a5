/* The smallest scene with everything that a render needs: a floor, a lamp above it, a camera. */
#ifndef TESTS_CLI_TINY_SCENE_H
#define TESTS_CLI_TINY_SCENE_H

#include <stdbool.h>

enum { TINY_SCENE_TRIANGLES = 4, TINY_SCENE_INSTANCES = 2, TINY_SCENE_MATERIALS = 2 };

/* Writes a glTF file, its buffer embedded. Its cameras are "Front" and "Side". */
bool tiny_scene_write(const char *path);

/* The same with an image that is not there, which nothing uses, and two animations of the lamp,
 * from 0 to 1 s: "Slide", and one whose name holds a bell and an escape sequence. */
bool tiny_scene_write_moving(const char *path);

#endif

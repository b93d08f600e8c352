// SPDX-License-Identifier: MIT
/*
 * images.h - draws the textures and the sky of the scenes
 *
 * Units:     pixels; PNG in sRGB, the sky in radiance
 * Threads:   one
 * Errors:    stop the program with a message
 */
#ifndef SCENES_IMAGES_H
#define SCENES_IMAGES_H

/* planks.png, paper.png, rug.png, painting.png, tiles.png and sky.hdr */
void images_write(const char *folder);

#endif

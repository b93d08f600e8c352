// SPDX-License-Identifier: MIT
/*
 * example.c - a program that uses libglim as others do: opens a scene, sets it
 * up, renders with a progress line, stops after some calls if asked, reads the
 * picture and saves it
 *
 * usage: example SCENE PICTURE [STOP_AFTER]
 */
#include <stdio.h>
#include <stdlib.h>

#include <glim/glim.h>

static bool on_progress(void *context, const struct glim_progress *p)
{
    int *calls_left = context; /* below 0: it never wants a stop */

    printf("%d of %d samples a pixel\n", (int)p->spp, (int)p->spp_limit);
    return *calls_left < 0 || (*calls_left)-- > 0;
}

static void print_mean(struct glim *g)
{
    int width, height;
    double sum = 0;

    glim_get_picture_size(g, &width, &height);
    size_t count = 3 * (size_t)width * (size_t)height;
    uint8_t *rgb = malloc(count);
    if (rgb != NULL && glim_read_bytes(g, rgb, count, NULL)) {
        for (size_t i = 0; i < count; i++)
            sum += rgb[i];
        printf("%dx%d, mean %.1f\n", width, height, sum / (double)count);
    }
    free(rgb);
}

static bool render(struct glim *g, const char *picture, int calls_left,
                   struct glim_error *err)
{
    struct glim_camera camera = glim_get_camera(g);
    enum glim_result result;

    if (!glim_set_size(g, 96, 0, err) || !glim_set_camera(g, &camera, err))
        return false;
    glim_set_seed(g, 7);
    result = glim_render(g, 8, 0, on_progress, &calls_left, err);
    if (result == GLIM_STOPPED)
        printf("stopped\n");
    if (result != GLIM_FAILED)
        print_mean(g);
    return result != GLIM_FAILED && glim_save(g, picture, err);
}

int main(int argc, char **argv)
{
    struct glim_error err = {"usage: example SCENE PICTURE [STOP_AFTER]"};
    struct glim *g = argc < 3 ? NULL : glim_open(argv[1], NULL, &err);
    bool ok =
        g != NULL && render(g, argv[2], argc > 3 ? atoi(argv[3]) : -1, &err);

    if (!ok)
        fprintf(stderr, "example: %s\n", err.text);
    glim_close(g);
    return ok ? 0 : 1;
}

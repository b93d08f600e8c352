// SPDX-License-Identifier: MIT
/*
 * keymap_list.h - the commands: their actions, names in the configuration, what
 * they do, other words for that, and keys
 *
 * keymap.h and keymap.c include it with their own GROUP(title) and
 * KEY(action, name, text, words, keys...). The list of commands shows the text
 * and is searched by all of it; a NULL text is not listed. Capitals of the keys
 * that move the camera move it ten times as fast.
 */
GROUP("Move")
KEY(FORWARD, "forward", "move forward", "walk fly dolly", 'w', 'W')
KEY(BACK, "back", "move back", "walk fly dolly", 's', 'S')
KEY(LEFT, "left", "move left", "walk pan", 'a', 'A')
KEY(RIGHT, "right", "move right", "walk pan", 'd', 'D')
KEY(DOWN, "down", "move down", "pan", 'q', 'Q', TTY_KEY_PAGE_DOWN)
KEY(UP, "up", "move up", "pan", 'e', 'E', TTY_KEY_PAGE_UP)
KEY(LOOK_LEFT, "look-left", "look left", "turn rotate yaw", TTY_KEY_LEFT)
KEY(LOOK_RIGHT, "look-right", "look right", "turn rotate yaw", TTY_KEY_RIGHT)
KEY(LOOK_UP, "look-up", "look up", "turn tilt pitch", TTY_KEY_UP)
KEY(LOOK_DOWN, "look-down", "look down", "turn tilt pitch", TTY_KEY_DOWN)
KEY(FASTER, "faster", "move faster; also the wheel", "speed", '+', '=')
KEY(SLOWER, "slower", "move slower", "speed", '-', '_')
KEY(WALLS, "walls", "go through walls, or not", "collision", 'j', 'J')
GROUP("Pick")
KEY(CURSOR, "cursor", "show a cursor that picks", "select object", 'v', 'V')
KEY(CANCEL, "cancel", "one level back; menu", "leave close", ESCAPE)
KEY(ORBIT, "orbit", "orbit the picked point", "rotate turntable", 'o')
KEY(FRAME, "frame", "frame the picked object", "zoom fit", 'z')
KEY(FRAME_ALL, "frame-all", "frame the whole scene", "zoom fit", 'Z')
GROUP("Camera")
KEY(NARROWER, "narrower", "narrower field of view", "zoom in fov lens", '[')
KEY(WIDER, "wider", "wider field of view", "zoom out fov lens", ']')
KEY(FOCUS, "focus", "focus on the picked point", "depth of field sharp", 'f')
KEY(CLOSE, "close-lens", "close the aperture", "depth of field", '{')
KEY(OPEN, "open-lens", "open the aperture", "depth of field bokeh", '}')
KEY(UNDO, "undo", "undo the last change", "revert back", 'u')
KEY(REDO, "redo", "redo a change", "", 'U')
KEY(RESET, "reset", "view as opened; whole scene", "reset home revert", 'r',
    'R', TTY_KEY_HOME)
GROUP("Views")
KEY(VIEW_1, "view-1", "go to view 1, or 2 to 9", "bookmark camera", '1')
KEY(VIEW_2, "view-2", NULL, "", '2')
KEY(VIEW_3, "view-3", NULL, "", '3')
KEY(VIEW_4, "view-4", NULL, "", '4')
KEY(VIEW_5, "view-5", NULL, "", '5')
KEY(VIEW_6, "view-6", NULL, "", '6')
KEY(VIEW_7, "view-7", NULL, "", '7')
KEY(VIEW_8, "view-8", NULL, "", '8')
KEY(VIEW_9, "view-9", NULL, "", '9')
KEY(KEEP, "keep", "give this view a number", "bookmark camera", 'k')
KEY(VIEWS, "views", "list of numbered views", "bookmark camera", '\'')
KEY(SAVE_VIEW, "save-view", "write the view file", "save camera", 'c')
GROUP("Look")
KEY(VIEW_NEXT, "next-view", "preview, normals, costs, ..",
    "wireframe albedo depth uv aov", 'n')
KEY(VIEW_BACK, "previous-view", "the same, backwards", "normals depth", 'N')
KEY(KEEP_RENDER, "keep-render", "keep this render", "snapshot", 'K')
KEY(COMPARE, "compare", "compare with a kept render", "wipe difference", 'y',
    'Y')
KEY(FILTER, "filter", "filter noise, or show it", "denoise smooth", 'F')
KEY(DRAWING, "drawing", "draw boxes, lobes, a path", "bvh wireframe debug", 't',
    'T')
KEY(LESS, "less", "level or step of it: less", "", '<')
KEY(MORE, "more", "level or step of it: more", "", '>')
GROUP("Edit")
KEY(PANEL, "panel", "materials, objects, light",
    "texture colour edit roughness", '\t')
KEY(LIGHT, "light", "sun, sky, lamps, exposure", "light tone brightness", 0)
KEY(ADD_LAMP, "add-lamp", "add a lamp", "new light point", 0)
KEY(SAVE_EDIT, "save-changes", "save what was changed", "write mtl view",
    CTRL('S'))
GROUP("Render")
KEY(MODE, "mode", "live mode, normal mode", "final render", ' ')
KEY(START, "start", "start, pause, continue", "stop halt", '\r')
KEY(STEP, "step", "one more sample, then pause", "", '.')
KEY(RESTART, "restart", "render again from sample 0", "clear", '0')
KEY(BACKEND, "backend", "OpenCL device, or CPU", "gpu", 'b', 'B')
GROUP("Files")
KEY(SCENE, "open-scene", "open another scene", "load file browse recent", 'O')
KEY(SAVE, "save", "save a PNG file, as shown",
    "screenshot export picture image", 'p')
KEY(SAVE_RAW, "save-raw", "save a PNG with its noise", "export picture raw", 0)
KEY(SAVE_LINEAR, "save-linear", "save a linear HDR file", "export picture", 'P')
KEY(SAVE_EXR, "save-exr", "save a linear EXR file", "export picture openexr", 0)
KEY(SAVE_TEXT, "save-text", "save coloured text", "export ansi", 'x', 'X')
KEY(RESTORE, "restore", "go on with what was kept", "recover session",
    CTRL('R'))
KEY(DROP, "drop-kept", "drop the kept session", "recover", 0)
KEY(RELOAD, "reload", "load changed files", "refresh revert", 'l', 'L')
GROUP("Screen")
KEY(COLORS, "colors", "colours: 24 bit, 256, 16", "palette", 'C')
KEY(THEME, "theme", "text dark, light or plain", "theme colours", 0)
KEY(GLYPHS, "glyphs", "blocks, .., pixels", "sixel kitty", 'G')
KEY(ABOUT, "about", "about this render",
    "progress statistics times speed threads size", 'g')
KEY(HIDE, "hide", "only the picture, or status", "full screen", 'i', 'I')
KEY(MOUSE, "mouse", "mouse off, on", "", 'm', 'M')
KEY(REDRAW, "redraw", "redraw the screen", "", CTRL('L'))
KEY(HELP, "help", "all commands and keys", "palette search", '?', ':',
    TTY_KEY_F1)
KEY(SUSPEND, "suspend", "suspend", "background shell", CTRL('Z'))
KEY(ABORT, "abort", "exit at once; session stays", "kill", CTRL('\\'))
KEY(QUIT, "quit", "quit", "exit leave close", CTRL('Q'), CTRL('C'))

// SPDX-License-Identifier: MIT
/*
 * Runs a fuzz target with the contents of files, without a fuzzer.
 *
 * usage: replay SECONDS MEBIBYTES FILE...
 *
 * A file that takes more seconds of processor time, or more memory, ends the
 * program with an error.
 */
#include <sys/resource.h>

#include "base/file.h"
#include "fuzz.h"

static void replay(const char *path, long mebibytes)
{
    struct rusage usage;
    struct error err = {""};
    char *bytes;
    size_t size;

    require(file_read(path, &bytes, &size, &err), err.text);
    LLVMFuzzerTestOneInput((const uint8_t *)bytes, size);
    free(bytes);
    getrusage(RUSAGE_SELF, &usage);
    require(usage.ru_maxrss >> 10 <= mebibytes, "within its memory");
}

int main(int argc, char **argv)
{
    struct rlimit seconds;

    require(argc > 3, "SECONDS MEBIBYTES FILE...");
    seconds.rlim_cur = seconds.rlim_max = (rlim_t)atol(argv[1]);
    setrlimit(RLIMIT_CPU, &seconds);
    for (int i = 3; i < argc; i++)
        replay(argv[i], atol(argv[2]));
    return 0;
}

# SPDX-License-Identifier: MIT
# lib.sh - functions for the cases
#
# A case runs in an empty folder with glim in its path.

# Runs glim and prints its output and exit status.
run()
{
    glim "$@" </dev/null 2>&1
    echo "exit $?"
}

# Copies a text without seconds and error in the closing line.
untimed()
{
    sed -e 's/, [0-9.]* s\(, error .*\)*$/, T s/' \
        -e 's/^\(stopped by .* wrote .*\), error .*/\1/' "$@"
}

# Runs glim like run, without the seconds and the error in the closing line.
run_untimed()
{
    run "$@" | untimed
}

# Skips the case for this reason.
skip()
{
    echo "$*"
    exit 77
}

# Limits the memory to $1 KB from now on. Returns false for a program with
# sanitizers, which needs more than any limit.
limit_memory()
{
    # the inner shell reports the abort, which is discarded
    (ulimit -v "$1"; glim --version || exit 1) >/dev/null 2>&1 &&
        ulimit -v "$1"
}

# Copies the named scene with its files into the current folder.
take()
{
    for scene in "$@"; do
        cp "$CLI/scenes/$scene".* .
    done
}

# Compares two files byte by byte and prints whether they are equal.
same()
{
    if cmp -s "$1" "$2"; then
        echo "$1 and $2: the same bytes"
    else
        echo "$1 and $2: different"
    fi
}

# Prints the four bytes at `offset` as an unsigned big-endian number.
be32()
{
    od -A n -t u1 -j "$2" -N 4 "$1" |
        awk '{ print (($1 * 256 + $2) * 256 + $3) * 256 + $4 }'
}

# Prints the format and the size of a picture.
kind()
{
    case $(head -c 8 "$1" | od -A n -t x1 | tr -d ' \n') in
    89504e470d0a1a0a) echo "$1: PNG $(be32 "$1" 16)x$(be32 "$1" 20)" ;;
    50460a*) echo "$1: PFM $(sed -n '2{p;q;}' "$1" | tr ' ' x)" ;;
    233f5241*) echo "$1: HDR $(sed -n '/^-Y/{p;q;}' "$1")" ;;
    762f3101*) echo "$1: EXR of" $(exr_channels "$1") ;;
    *) echo "$1: no picture" ;;
    esac
}

# Prints the names of the channels of an EXR file, which its header lists first,
# behind the size of the list.
exr_channels()
{
    head -c 1000 "$1" | tr '\0' '\n' | sed -n '/^chlist$/,/^compression$/p' |
        sed 1,2d | grep -ax '[A-Za-z.]*[A-Z]'
}

# Prints the floats of a PFM file, three a line: its last width * height * 12
# bytes.
floats()
{
    tail -c $(($2 * $3 * 12)) "$1" | od -A n -v -w12 -t f4
}

# Writes textured.obj, .mtl and .view: $1 faces under a white sky, each with an
# image of its own, 1.tga and so on.
textured()
{
    echo 'background 1 1 1' >textured.view
    printf 'mtllib textured.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n' >textured.obj
    printf 'vt 0 0\nvt 1 0\nvt 0 1\n' >>textured.obj
    for i in $(seq "$1"); do
        printf 'usemtl m%s\nf 1/1 2/2 3/3\n' "$i" >>textured.obj
        printf 'newmtl m%s\nmap_Kd %s.tga\n' "$i" "$i"
    done >textured.mtl
}

# Writes a NumPy file of bytes: their shape, and the bytes as printf has them.
npy() # SHAPE BYTES
{
    printf '\223NUMPY\001\000\166\000%-117s\n' \
        "{'descr': '|u1', 'fortran_order': False, 'shape': ($1), }"
    printf "$2"
}

# Finds the program of clusters, and lets the superuser run it.
mpi_program()
{
    mpi=${BUILD:-build/release}/mpi/glim
    case $mpi in
    /*) ;;
    *) mpi=$root/$mpi ;;
    esac
    command -v mpirun >/dev/null || skip no mpirun
    [ -x "$mpi" ] || skip no program with MPI
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
}

# Runs that many ranks, and shows what they say of a picture or of an error.
ranks() # COUNT OPTION...
{
    count=$1
    shift
    timeout -k 5 60 mpirun --oversubscribe -n $count "$mpi" "$@" 2>&1 |
        grep -E 'glim|spp' | untimed
}

#!/usr/bin/env bash
# compile_cached.sh PROJECT COMPILER ARGUMENT...: runs the compiler through ccache so that what one clone has compiled another finds:
# no command line and no debug information has the path of a clone. Of a path below the working folder, which is the build's, only the
# relative part is passed on: ccache leaves those that follow -Xclang as they are.
export CCACHE_BASEDIR=$1 CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros
shift
exec ccache "${@/#"$PWD"\//}"

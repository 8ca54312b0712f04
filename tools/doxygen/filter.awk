# What Doxygen reads of a header: the inline namespaces of versions and tags become the group of the folder, so that names
# read as they are used (insonify::render) and the reference is grouped by module.
FNR == 1 {
    module = FILENAME
    sub(/.*insonify\//, "", module)
    module = module ~ /\// ? substr(module, 1, index(module, "/") - 1) : "core"
}
/^inline namespace INSONIFY_ABI \{$/ { print "/** @addtogroup " module " \\ilinebr @{ */"; next }
/^inline namespace INSONIFY_[A-Z_]+ \{\}?$/ { print ""; next }
/^\} +\/\/ (inline )?namespace INSONIFY_ABI$/ { print "/** @} */"; next }
/^\} +\/\/ (inline )?namespace INSONIFY_[A-Z_]+$/ { print ""; next }
{ print }

// Throws the library's errors as JavaScript errors.
mergeInto(LibraryManager.library, {
    playground_fail: function (message) {
        throw new Error(UTF8ToString(message));
    }
});

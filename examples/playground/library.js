// What the module needs from JavaScript: errors of the library become JavaScript's.
mergeInto(LibraryManager.library, {
    playground_fail: function (message) {
        throw new Error(UTF8ToString(message));
    }
});

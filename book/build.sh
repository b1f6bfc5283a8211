#!/usr/bin/env bash
# Builds the book into target/book (or the folder given) and checks every link and anchor of what it built.
# Needs mdbook: cargo install --locked mdbook. With LINKWEAR=path/to/linkwear the live pages are made too.
# Pages are the Markdown files of book/src, of docs and of the repository's top. Their links hold in the repository; here the files are laid out
# in one tree, so that the same links hold in the book.
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(realpath -m "${1:-target/book}")
web=https://github.com/linkwear/linkwear/tree/main
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT

cp book/book.toml book/wide.css "$stage"
cp -r book/src "$stage/src"
mkdir -p "$stage/src/docs" "$stage/src/examples/downstream/src"
cp -r docs/* "$stage/src/docs"
cp -n mechanisms/*.toml "$stage/src/mechanisms"
cp examples/downstream/build.rs "$stage/src/examples/downstream"
cp examples/downstream/src/main.rs "$stage/src/examples/downstream/src"
cp ARCHITECTURE.md CONTRIBUTING.md CHANGELOG.md SECURITY.md LICENSE-APACHE LICENSE-MIT "$stage/src"
# A page of docs that the summary does not have comes last.
further="\n# Further pages\n\n"
for page in docs/*.md; do
    if ! grep -qF "(../../$page)" book/src/SUMMARY.md; then
        printf "$further- [%s](../../%s)\n" "$(sed -n '1s/^# //p' "$page")" "$page" >> "$stage/src/SUMMARY.md"
        further=
    fi
done
pages=$(cd "$stage/src" && find . -name '*.md')
for page in $pages; do
    file="$stage/src/$page"
    # The folder of the page as it is in the repository, and the way up from it; here a page of the book lies two folders higher.
    case $page in
    ./SUMMARY.md) home=book/src up=../../ ;;
    ./docs/case-study/*) home=docs/case-study up=../../ ;;
    ./docs/*) home=docs up=../ ;;
    ./[A-Z]*) home=. up= ;;
    ./cookbook/*) home=book/src/cookbook up=../../../ ;;
    *) home=book/src up=../../ ;;
    esac
    from=$(dirname "$page")
    back=$(realpath -m --relative-to="$stage/src/$from" "$stage/src")/
    [ "$back" != ./ ] || back=
    sed -i "s|{{#include ${up:-@}|{{#include $back|g" "$file"
    for link in $(grep -oE '\]\([^)#]+[^)]*\)' "$file" | sed 's/^](//; s/)$//; s/#.*//' | sort -u | grep -vE '^[a-z]+:|^\{\{'); do
        path=$(realpath -m --relative-to=. "$home/$link")
        if [ ! -e "$path" ]; then
            echo "book: $page: no file $link" >&2
            exit 1
        fi
        here=${path#book/src/}
        # What the book does not hold is on the repository's web page.
        if [ -f "$stage/src/$here" ]; then target=$back$here; else target=$web/$path; fi
        sed -i "s|](${link//./\\.}\([)#]\)|](\n$target\1|g" "$file"
    done
    # A line break keeps a link that is done from being taken for another.
    sed -i ':all; N; $!b all; s|](\n|](|g' "$file"
done
if [ -n "${LINKWEAR:-}" ]; then
    mkdir "$stage/src/live"
    for marker in $(grep -hoE '<!-- live: [a-z_]+\.html -->' "$stage"/src/*.md | grep -oE '[a-z_]+\.html' | sort -u); do
        "$LINKWEAR" report "book/src/mechanisms/${marker%.html}.toml" --trajectories 200 -o "$stage/src/live/$marker" > "$stage/report.txt"
        sed -i "s|<!-- live: $marker -->|<iframe src=\"live/$marker\" title=\"The page of the report\" loading=\"lazy\"></iframe>|" "$stage"/src/*.md
    done
fi
mdbook build "$stage" --dest-dir "$out"

# Every address within the book leads to a file, every anchor to an element.
dead=0
while IFS=: read -r file address; do
    address=${address#*\"}
    address=${address%\"}
    case $address in http://* | https://* | mailto:* | data:* | javascript:* | "") continue ;; esac
    target=${address%%#*}
    target=${target%%\?*}
    anchor=
    case $address in *"#"*) anchor=${address#*#} ;; esac
    path="$file"
    [ -z "$target" ] || path="$(dirname "$file")/$target"
    [ -d "$path" ] && path="$path/index.html"
    if [ ! -f "$path" ]; then
        echo "book: $file: no file $target" >&2
        dead=1
    elif [ -n "$anchor" ] && [ "${path##*.}" = html ] && ! grep -qE "id=\"$anchor\"" "$path"; then
        echo "book: $file: no anchor $address" >&2
        dead=1
    fi
done < <(cd "$out" && grep -roE --include='*.html' --exclude=print.html --exclude=toc.html --exclude=404.html --exclude-dir=live '(href|src)="[^"]*"' . | sed 's/&amp;/\&/g' | sort -u | sed "s|^\./|$out/|")
exit "$dead"

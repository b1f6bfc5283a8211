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
mkdir "$stage/src/docs"
cp -r docs/* "$stage/src/docs"
cp ARCHITECTURE.md CONTRIBUTING.md CHANGELOG.md SECURITY.md README.md LICENSE-APACHE LICENSE-MIT "$stage/src"
pages=$(cd "$stage/src" && find . -name '*.md')
for page in $pages; do
    from=$(dirname "$page")
    case $page in
    ./docs/* | ./[A-Z]*.md) [ "$page" = ./SUMMARY.md ] && up=../../ || up= ;;
    ./cookbook/*) up=../../../ ;;
    *) up=../../ ;;
    esac
    file="$stage/src/$page"
    # A page of the book lies two folders deep in the repository, here at the top.
    if [ -n "$up" ]; then
        sed -i "s|](${up//./\\.}|](${up#../../}|g" "$file"
    else
        sed -i "s|](\(\.\./\)\{0,1\}book/src/|](\1|g" "$file"
    fi
    # What the book does not hold is on the repository's web page.
    links=$(grep -oE '\]\([^)#]+[^)]*\)' "$file" | sed 's/^](//; s/)$//; s/#.*//' | sort -u | grep -vE '^[a-z]+:|^\{\{' || true)
    for link in $links; do
        path=$(realpath -m --relative-to="$stage/src" "$stage/src/$from/$link")
        if [ ! -f "$stage/src/$path" ]; then
            if [ ! -e "$path" ] && [ ! -e "book/src/$path" ]; then
                echo "book: $page: no file $link" >&2
                exit 1
            fi
            [ -e "$path" ] || path="book/src/$path"
            sed -i "s|](${link//./\\.}\([)#]\)|]($web/$path\1|g" "$file"
        fi
    done
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

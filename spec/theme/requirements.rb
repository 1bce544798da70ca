# SPDX-License-Identifier: BSD-2-Clause
# Prints the numbers of requirements, which are anchors in the source and would otherwise not be visible. Also embeds files that
# belong to the text, byte for byte: attached:tables/x.csv[] is a link that contains the file, in a PDF an attachment.
require 'asciidoctor/extensions'
require 'base64'

Asciidoctor::Extensions.register do
  include_processor do
    def self.numbered(text)
      text.gsub(/^((?:[*.]+ )?)\[\[(REQ-[A-Z]+-\d+)\]\](?=\S)/, '\1[[\2]][.req]#\2# ')
    end

    processor = self
    handles? { |target| target.start_with? 'clauses/' }
    process do |doc, reader, target, attributes|
      path = File.expand_path target, doc.attr('docdir')
      if File.file? path
        reader.push_include processor.numbered(File.read(path, encoding: 'utf-8')), path, target, 1, attributes
      elsif !attributes.key?('optional-option')
        raise "#{target} is missing"
      end
      reader
    end
  end

  inline_macro do
    named :attached
    process do |parent, target, _|
      doc, name = parent.document, File.basename(target)
      data = File.binread File.expand_path(target, doc.attr('docdir'))
      if doc.backend == 'pdf'
        create_inline_pass parent, name
      else
        url = "data:text/csv;base64,#{Base64.strict_encode64 data}"
        create_inline_pass parent, %(<a download="#{name}" href="#{url}">#{name}</a>)
      end
    end
  end
end

if defined? Asciidoctor::PDF
  # Embeds the attached files in the PDF before it is written.
  class AttachingConverter < Asciidoctor::Converter.for('pdf')
    register_for 'pdf'

    def convert_document(doc)
      @attached_from = doc.attr 'docdir'
      super
    end

    def write(pdf, target)
      paths = Dir[File.join(@attached_from, 'tables', '*.csv')].sort
      tree = paths.flat_map { |path| [PDF::Core::LiteralString.new(File.basename(path)), filespec(pdf, path)] }
      pdf.names.data[:EmbeddedFiles] = pdf.ref!(Names: tree)
      super
    end

    private

    def filespec(pdf, path)
      data, name = File.binread(path), PDF::Core::LiteralString.new(File.basename(path))
      file = pdf.ref!(Type: :EmbeddedFile, Subtype: :'text/csv', Params: { Size: data.bytesize })
      file.stream << data
      pdf.ref!(Type: :Filespec, F: name, UF: name, EF: { F: file, UF: file })
    end
  end
end
